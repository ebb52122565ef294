// SPDX-License-Identifier: MIT
// pugixml reads; what is here gives names their spaces and everything its place in the text.
#include "xml.h"

#include <algorithm>
#include <pugixml.hpp>
#include <utility>

namespace puppetri::notation::xml {
namespace {

using Spaces = std::vector<std::pair<std::string, std::string>>;  // prefixes, inner ones last

class Copier {
 public:
    Copier(std::string_view text, std::uint32_t file, Document& out)
        : text_(text), file_(file), out_(out) {}

    void fail(std::string code, std::size_t at, std::string message, std::string remedy) {
        if (out_.defects.empty()) {
            out_.defects.push_back(
                {std::move(code), std::move(message), std::move(remedy), span(at, at + 1)});
        }
    }

    // Needs what `too_deep` refuses to be refused before: it recurses.
    void copy(const pugi::xml_node& from, Element& to) {
        // pugixml points behind the "<".
        const auto begin = static_cast<std::size_t>(from.offset_debug()) - 1;
        const std::size_t kept = spaces_.size();
        std::size_t at = begin + 1 + std::string_view(from.name()).size();
        for (const pugi::xml_attribute a : from.attributes()) {
            attribute(a, begin, at, to);
        }
        const std::string_view full = from.name();
        const std::size_t colon = full.find(':');
        to.name = full.substr(colon == full.npos ? 0 : colon + 1);
        const std::string_view prefix = full.substr(0, colon == full.npos ? 0 : colon);
        for (auto space = spaces_.rbegin(); space != spaces_.rend(); ++space) {
            if (space->first == prefix) {
                to.space = space->second;
                break;
            }
        }
        to.span = span(begin, std::min(text_.find('>', at), text_.size() - 1) + 1);
        for (const pugi::xml_node c : from.children()) {
            if (c.type() == pugi::node_element) {
                copy(c, to.children.emplace_back());
            } else if (c.type() == pugi::node_pcdata || c.type() == pugi::node_cdata) {
                to.text += c.value();
            }
        }
        spaces_.resize(kept);
    }

 private:
    lang::Span span(std::size_t begin, std::size_t end) const {
        const auto inside = [&](std::size_t at) {
            return static_cast<std::uint32_t>(std::min(at, text_.size()));
        };
        return {inside(begin), inside(end), file_};
    }

    // pugixml does not say where attributes are; they come in their order, from `at` on.
    void attribute(const pugi::xml_attribute& from, std::size_t element, std::size_t& at,
                   Element& to) {
        Attribute a{from.name(), from.value(), {}};
        const std::size_t equals = text_.find('=', text_.find(a.name, at));
        const std::size_t open = text_.find_first_of("\"'", equals);
        const std::size_t close = open == text_.npos ? open : text_.find(text_[open], open + 1);
        if (close != text_.npos) {
            a.span = span(open + 1, close);
            at = close + 1;
        }
        if (to.find(a.name) != nullptr) {
            fail("bad-xml", element, "the attribute " + a.name + " is given twice",
                 "keep one of them");
        }
        if (a.name == "xmlns") {
            spaces_.emplace_back("", a.value);
        } else if (a.name.rfind("xmlns:", 0) == 0) {
            spaces_.emplace_back(a.name.substr(6), a.value);
        }
        to.attributes.push_back(std::move(a));
    }

    std::string_view text_;
    std::uint32_t file_;
    Document& out_;
    Spaces spaces_;
};

// Nested deeper than this, counted by tags alone, is refused before anything recurses.
bool too_deep(const pugi::xml_node& root) {
    int depth = 0;
    for (pugi::xml_node n = root; n;) {
        if (n.first_child()) {
            n = n.first_child();
            if (++depth > kMaxDepth) {
                return true;
            }
            continue;
        }
        while (n && !n.next_sibling()) {
            n = n.parent();
            --depth;
        }
        n = n.next_sibling();
    }
    return false;
}

// The first & that pugixml would leave as it is: of no entity that XML has. None: npos.
std::size_t unknown_entity(std::string_view text) {
    for (std::size_t at = text.find_first_of("<&"); at < text.size();
         at = text.find_first_of("<&", at + 1)) {
        const auto skip = [&](std::string_view open, std::string_view close) {
            const bool here = text.substr(at, open.size()) == open;
            at = here ? std::min(text.find(close, at), text.size() - 1) : at;
            return here;
        };
        if (skip("<!--", "-->") || skip("<![CDATA[", "]]>") || skip("<?", "?>") ||
            text[at] == '<') {
            continue;
        }
        const std::string_view rest = text.substr(at + 1, 12);
        const std::string_view name = rest.substr(0, rest.find(';'));
        const bool known = name == "amp" || name == "lt" || name == "gt" || name == "quot" ||
                           name == "apos" || (!name.empty() && name[0] == '#');
        if (!known || name.size() == rest.size()) {
            return at;
        }
    }
    return std::string_view::npos;
}

}  // namespace

const Attribute* Element::find(std::string_view attribute) const {
    for (const Attribute& a : attributes) {
        if (a.name == attribute) {
            return &a;
        }
    }
    return nullptr;
}

Document parse(std::string_view text, std::uint32_t file) {
    Document out;
    Copier copier(text, file, out);
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(
        text.data(), text.size(), pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
    if (!result) {
        copier.fail("bad-xml", static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)),
                    std::string("this is no XML: ") + result.description(),
                    "mend the file there; programs that write XML do not make this");
        return out;
    }
    if (const std::size_t at = unknown_entity(text); at != text.npos) {
        copier.fail("bad-xml", at, "this & begins no entity that XML has",
                    "write &amp;, or write out what the entity stands for");
    }
    std::size_t elements = 0;
    for (const pugi::xml_node n : document.children()) {
        if (n.type() == pugi::node_doctype) {
            copier.fail("xml-document-type", text.find("<!DOCTYPE"),
                        "document types, and entities of their own, are not read",
                        "remove the DOCTYPE, and write out what its entities stand for");
        } else if (n.type() == pugi::node_element && ++elements > 1) {
            copier.fail("bad-xml", static_cast<std::size_t>(n.offset_debug()),
                        "there is something behind the last element", "remove it");
        }
    }
    if (elements == 0) {
        copier.fail("bad-xml", 0, "an element is wanted here", "write <scxml ...>");
    }
    if (out.defects.empty() && too_deep(document.document_element())) {
        copier.fail("bad-xml", 0,
                    "elements are nested more than " + std::to_string(kMaxDepth) + " deep",
                    "nest less");
    }
    if (out.defects.empty()) {
        copier.copy(document.document_element(), out.root);
    }
    return out;
}

}  // namespace puppetri::notation::xml
