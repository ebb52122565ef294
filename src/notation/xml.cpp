// SPDX-License-Identifier: MIT
#include "xml.h"

#include <algorithm>
#include <utility>

namespace puppetri::notation::xml {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool is_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.' || c == ':' || static_cast<unsigned char>(c) >= 0x80;
}

void append_utf8(std::string& out, std::uint32_t c) {
    if (c < 0x80) {
        out += static_cast<char>(c);
    } else if (c < 0x800) {
        out += static_cast<char>(0xC0 | (c >> 6));
        out += static_cast<char>(0x80 | (c & 63));
    } else if (c < 0x10000) {
        out += static_cast<char>(0xE0 | (c >> 12));
        out += static_cast<char>(0x80 | ((c >> 6) & 63));
        out += static_cast<char>(0x80 | (c & 63));
    } else {
        out += static_cast<char>(0xF0 | (c >> 18));
        out += static_cast<char>(0x80 | ((c >> 12) & 63));
        out += static_cast<char>(0x80 | ((c >> 6) & 63));
        out += static_cast<char>(0x80 | (c & 63));
    }
}

class Reader {
 public:
    Reader(std::string_view text, std::uint32_t file) : text_(text), file_(file) {}

    Document read() {
        skip_misc();
        if (good() && (at_ >= text_.size() || text_[at_] != '<')) {
            fail("bad-xml", at_, "an element is wanted here", "write <scxml ...>");
        }
        if (good()) {
            element(out_.root, 0);
        }
        if (good()) {
            skip_misc();
        }
        if (good() && at_ < text_.size()) {
            fail("bad-xml", at_, "there is something behind the last element", "remove it");
        }
        return std::move(out_);
    }

 private:
    bool good() const { return out_.defects.empty(); }

    void fail(std::string code, std::size_t at, std::string message, std::string remedy) {
        if (good()) {
            const auto begin = static_cast<std::uint32_t>(std::min(at, text_.size()));
            const auto end = static_cast<std::uint32_t>(std::min(at + 1, text_.size()));
            out_.defects.push_back(
                {std::move(code), std::move(message), std::move(remedy), {begin, end, file_}});
        }
    }

    bool take(std::string_view what) {
        if (text_.substr(at_, what.size()) != what) {
            return false;
        }
        at_ += what.size();
        return true;
    }

    void skip_space() {
        while (at_ < text_.size() && is_space(text_[at_])) {
            ++at_;
        }
    }

    // Comments and processing instructions; true: there was one, or a defect.
    bool skip_one() {
        const std::size_t begin = at_;
        const auto skip_to = [&](std::string_view end, const char* what) {
            const std::size_t found = text_.find(end, at_);
            if (found == text_.npos) {
                fail("bad-xml", begin, std::string(what) + " has no end",
                     "write " + std::string(end) + " behind it");
                at_ = text_.size();
            } else {
                at_ = found + end.size();
            }
            return true;
        };
        if (take("<!--")) {
            return skip_to("-->", "this comment");
        }
        if (take("<?")) {
            return skip_to("?>", "this instruction");
        }
        if (take("<!DOCTYPE")) {
            fail("xml-document-type", begin,
                 "document types, and entities of their own, are not read",
                 "remove the DOCTYPE, and write out what its entities stand for");
            return true;
        }
        return false;
    }

    void skip_misc() {
        do {
            skip_space();
        } while (good() && skip_one());
    }

    std::string_view name() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && is_name(text_[at_])) {
            ++at_;
        }
        if (at_ == begin) {
            fail("bad-xml", at_, "a name is wanted here",
                 "write the name of an element or attribute");
        }
        return text_.substr(begin, at_ - begin);
    }

    // &amp; and the like, at text_[at_] == '&'.
    void entity(std::string& out) {
        const std::size_t begin = at_;
        const std::size_t end = text_.find(';', at_);
        if (end == text_.npos || end - at_ > 12) {
            return fail("bad-xml", begin, "this & begins no entity", "write &amp;");
        }
        const std::string_view body = text_.substr(at_ + 1, end - at_ - 1);
        at_ = end + 1;
        static constexpr std::pair<std::string_view, char> kKnown[] = {
            {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
        for (const auto& [known, c] : kKnown) {
            if (known == body) {
                out += c;
                return;
            }
        }
        if (body.size() > 1 && body[0] == '#') {
            const bool hex = body[1] == 'x';
            std::uint32_t value = 0;
            bool digits = body.size() > (hex ? 2u : 1u);
            for (const char c : body.substr(hex ? 2 : 1)) {
                const int digit = c >= '0' && c <= '9'          ? c - '0'
                                  : hex && c >= 'a' && c <= 'f' ? c - 'a' + 10
                                  : hex && c >= 'A' && c <= 'F' ? c - 'A' + 10
                                                                : -1;
                digits = digits && digit >= 0 && value < 0x200000;
                value =
                    value * (hex ? 16u : 10u) + static_cast<std::uint32_t>(digit < 0 ? 0 : digit);
            }
            if (digits && value > 0 && value <= 0x10FFFF && (value < 0xD800 || value > 0xDFFF)) {
                return append_utf8(out, value);
            }
        }
        fail("bad-xml", begin, "there is no entity &" + std::string(body) + ";",
             "write out what it stands for");
    }

    void attribute(Element& e, std::vector<std::pair<std::string, std::string>>& spaces) {
        Attribute a;
        const std::size_t begin = at_;
        a.name = name();
        skip_space();
        if (good() && !take("=")) {
            fail("bad-xml", at_, "= is wanted here", "write NAME=\"VALUE\"");
        }
        skip_space();
        const char quote = at_ < text_.size() ? text_[at_] : '\0';
        if (good() && quote != '"' && quote != '\'') {
            fail("bad-xml", at_, "a value in quotes is wanted here", "write NAME=\"VALUE\"");
        }
        const std::size_t value = ++at_;
        while (good() && at_ < text_.size() && text_[at_] != quote) {
            if (text_[at_] == '&') {
                entity(a.value);
            } else if (text_[at_] == '<') {
                fail("bad-xml", at_, "this value has no end", "write a quote behind it");
            } else {
                a.value += text_[at_++];
            }
        }
        if (good() && at_ >= text_.size()) {
            fail("bad-xml", value, "this value has no end", "write a quote behind it");
        }
        a.span = {static_cast<std::uint32_t>(std::min(value, text_.size())),
                  static_cast<std::uint32_t>(std::min(at_, text_.size())), file_};
        ++at_;
        if (good() && e.find(a.name) != nullptr) {
            fail("bad-xml", begin, "the attribute " + a.name + " is given twice",
                 "keep one of them");
        }
        if (a.name == "xmlns") {
            spaces.emplace_back("", a.value);
        } else if (a.name.rfind("xmlns:", 0) == 0) {
            spaces.emplace_back(a.name.substr(6), a.value);
        }
        e.attributes.push_back(std::move(a));
    }

    void element(Element& e, int depth) {
        const std::size_t begin = at_;
        if (depth >= kMaxDepth) {
            return fail("bad-xml", begin,
                        "elements are nested more than " + std::to_string(kMaxDepth) + " deep",
                        "nest less");
        }
        ++at_;
        const std::string full(name());
        const std::size_t kept = spaces_.size();
        for (;;) {
            const std::size_t before = at_;
            skip_space();
            if (!good() || at_ >= text_.size() || text_[at_] == '>' || text_[at_] == '/') {
                break;
            }
            if (at_ == before) {
                fail("bad-xml", at_, "a space is wanted here", "write a space before an attribute");
                break;
            }
            attribute(e, spaces_);
        }
        const std::size_t colon = full.find(':');
        const std::string prefix = colon == full.npos ? "" : full.substr(0, colon);
        e.name = colon == full.npos ? full : full.substr(colon + 1);
        for (auto space = spaces_.rbegin(); space != spaces_.rend(); ++space) {
            if (space->first == prefix) {
                e.space = space->second;
                break;
            }
        }
        const bool empty = good() && take("/");
        if (good() && !take(">")) {
            fail("bad-xml", begin, "this tag has no end", "write >");
        }
        e.span = {static_cast<std::uint32_t>(begin),
                  static_cast<std::uint32_t>(std::min(at_, text_.size())), file_};
        while (good() && !empty) {
            if (at_ >= text_.size()) {
                fail("bad-xml", begin, "the element " + full + " has no end",
                     "write </" + full + ">");
            } else if (take("<![CDATA[")) {
                const std::size_t end = text_.find("]]>", at_);
                if (end == text_.npos) {
                    fail("bad-xml", at_, "this text has no end", "write ]]> behind it");
                } else {
                    e.text += text_.substr(at_, end - at_);
                    at_ = end + 3;
                }
            } else if (take("</")) {
                const std::size_t tag = at_;
                if (name() != full) {
                    fail("bad-xml", tag, "this ends another element than " + full,
                         "write </" + full + ">");
                }
                skip_space();
                if (good() && !take(">")) {
                    fail("bad-xml", at_, "> is wanted here", "write </" + full + ">");
                }
                break;
            } else if (text_[at_] == '<') {
                if (!skip_one()) {
                    element(e.children.emplace_back(), depth + 1);
                }
            } else if (text_[at_] == '&') {
                entity(e.text);
            } else {
                e.text += text_[at_++];
            }
        }
        spaces_.resize(kept);
    }

    std::string_view text_;
    std::uint32_t file_;
    std::size_t at_ = 0;
    std::vector<std::pair<std::string, std::string>> spaces_;  // prefixes, inner ones last
    Document out_;
};

}  // namespace

const Attribute* Element::find(std::string_view attribute) const {
    for (const Attribute& a : attributes) {
        if (a.name == attribute) {
            return &a;
        }
    }
    return nullptr;
}

Document parse(std::string_view text, std::uint32_t file) { return Reader(text, file).read(); }

}  // namespace puppetri::notation::xml
