// SPDX-License-Identifier: MIT
#include "library.h"

#include "puppetri/lang/signature.h"
#include "puppetri/lang/units.h"
#include "puppetri/notation/foreign_file.h"
#include "puppetri/notation/notation.h"

namespace puppetri::scene {
namespace {

using lang::unknown_name;

class Loader {
 public:
    explicit Loader(FileSource& source) : source_(source) {}

    Library load(const std::string& path) {
        library_.source = &source_;
        if (const auto text = source_.read(path); text) {
            open(path, *text);
        } else {
            library_.diagnostics.push_back(
                {.code = "cannot-read",
                 .where = {.file = path},
                 .element = "file " + path,
                 .message = text.error().message,
                 .remedy = "look at the path and the rights of the file"});
            library_.readable = false;
            return std::move(library_);
        }
        // Imports are read breadth first; files_ grows while we go.
        for (std::uint32_t i = 0; i < library_.files.size(); ++i) {
            read_imports(i);
            read_event_files(i, library_.files[i].body);
        }
        for (std::uint32_t i = 0; i < library_.files.size(); ++i) {
            declare_imports(i);
        }
        for (std::uint32_t i = 0; i < library_.files.size(); ++i) {
            bind(i, library_.files[i].body);
        }
        return std::move(library_);
    }

 private:
    std::uint32_t open(const std::string& path, const std::string& text) {
        const auto number = static_cast<std::uint32_t>(library_.files.size());
        lang::Parsed parsed = notation::parse(text, path, number);
        broken_.push_back(has_errors(parsed.diagnostics));
        library_.readable = library_.readable && !broken_.back();
        for (Diagnostic& d : parsed.diagnostics) {
            library_.diagnostics.push_back(std::move(d));
        }
        library_.files.push_back(std::move(parsed.file));
        library_.texts.emplace_back();
        library_.casts.emplace_back();
        numbers_[path] = number;
        std::map<std::string, Declaration> names;
        const lang::Body& body = library_.files.back().body;
        for (const lang::Net& net : body.nets) {
            if (net.is_machine) {
                keep(notation::lower_machine(net, library_.files[number]), nullptr, net.name,
                     number, names);
            } else {
                declare(names, net.name, {.file = number, .net = &net});
            }
        }
        for (const lang::Enumeration& e : body.enumerations) {
            declare(names, e.name, {.file = number, .enumeration = &e});
        }
        for (const lang::TokenType& t : body.token_types) {
            declare(names, t.name, {.file = number, .token_type = &t});
        }
        for (const lang::Block& block : body.blocks) {
            if (is_movement_kind(block.kind.text) && !block.name.text.empty()) {
                declare(names, block.name, {.file = number, .block = &block});
            } else if (const auto* notation = notation::find_notation(block.kind.text)) {
                lower(*notation, block, number, names);
            }
        }
        library_.visible.push_back(std::move(names));
        return number;
    }

    // A block of a notation becomes a net like those that are written as such.
    void lower(const notation::Notation& notation, const lang::Block& block, std::uint32_t number,
               std::map<std::string, Declaration>& names) {
        if (block.name.text.empty()) {
            library_.diagnostics.push_back(
                {.code = "missing-name",
                 .where = library_.where(block.span),
                 .element = block.kind.text,
                 .message = "nothing can use this without a name",
                 .remedy = "write " + block.kind.text + " NAME { ... }"});
            library_.readable = false;
            return;
        }
        keep(notation::lower(notation, block, library_.files[number]), &block, block.name, number,
             names);
    }

    // `block` is null for a machine.
    void keep(notation::Lowered lowered, const lang::Block* block, const lang::Name& name,
              std::uint32_t number, std::map<std::string, Declaration>& names) {
        if (has_errors(lowered.diagnostics)) {
            broken_[number] = true;
            library_.readable = false;
        }
        for (Diagnostic& d : lowered.diagnostics) {
            library_.diagnostics.push_back(std::move(d));
        }
        library_.lowered.push_back(std::move(lowered.net));
        library_.lowered_from.push_back(block);
        declare(names, name, {.file = number, .net = &library_.lowered.back()});
    }

    void declare(std::map<std::string, Declaration>& names, const lang::Name& name,
                 const Declaration& d) {
        if (!names.emplace(name.text, d).second) {
            library_.diagnostics.push_back({.code = "name-twice",
                                            .where = library_.where(name.span),
                                            .element = name.text,
                                            .message = "this file already has a " + name.text,
                                            .remedy = "choose another name"});
        }
    }

    void read_imports(std::uint32_t file) {
        imported_.emplace_back();
        for (const lang::Import& import : library_.files[file].imports) {
            const std::string path = source_.resolve(library_.files[file].filename, import.path);
            if (const auto known = numbers_.find(path); known != numbers_.end()) {
                imported_.back().push_back(known->second);
                continue;
            }
            const auto text = source_.read(path);
            if (!text) {
                library_.diagnostics.push_back(
                    {.code = "cannot-read",
                     .where = library_.where(import.path_span),
                     .element = "import of " + path,
                     .message = text.error().message,
                     .remedy = "the path is relative to this file; look at its spelling"});
                imported_.back().push_back(kMissing);
                continue;
            }
            imported_.back().push_back(open(path, *text));
        }
    }

    void read_event_files(std::uint32_t file, const lang::Body& body) {
        for (const lang::EventFile& events : body.event_files) {
            const std::string path = source_.resolve(library_.files[file].filename, events.path);
            const auto text = source_.read(path);
            if (!text) {
                library_.diagnostics.push_back(
                    {.code = "cannot-read",
                     .where = library_.where(events.span),
                     .element = "events from " + path,
                     .message = text.error().message,
                     .remedy = "the path is relative to this file; look at its spelling"});
                continue;
            }
            library_.texts[file][events.path] = *text;
        }
    }

    void declare_imports(std::uint32_t file) {
        const std::vector<lang::Import>& imports = library_.files[file].imports;
        for (std::size_t i = 0; i < imports.size(); ++i) {
            const std::uint32_t from = imported_[file][i];
            for (const lang::Name& name : imports[i].names) {
                if (name.text == "cast") {
                    if (from != kMissing) {
                        library_.casts[file].push_back(from);
                    }
                    continue;
                }
                if (from == kMissing) {
                    declare(library_.visible[file], name, {});
                    continue;
                }
                const Declaration* found = nullptr;
                std::vector<std::string> known;
                for (const auto& [text, d] : library_.visible[from]) {
                    if (d.file == from) {
                        known.push_back(text);
                        found = text == name.text ? &d : found;
                    }
                }
                if (found == nullptr && broken_[from]) {  // its own errors say enough
                    declare(library_.visible[file], name, {});
                    continue;
                }
                if (found == nullptr) {
                    library_.diagnostics.push_back(unknown_name(library_.where(name.span), "net",
                                                                name.text, known,
                                                                "import from " + imports[i].path));
                    declare(library_.visible[file], name, {});
                    continue;
                }
                declare(library_.visible[file], name, *found);
            }
        }
    }

    // Uses of files in other notations whose lines are more than arguments.
    void bind(std::uint32_t file, lang::Body& body) {
        for (std::size_t i = 0; i < body.uses.size(); ++i) {
            lang::Use& use = body.uses[i];
            const notation::ForeignFormat* format = notation::find_foreign_format(use.path);
            if (format == nullptr || format->bind == nullptr || use.args.empty()) {
                continue;
            }
            const auto found = library_.visible[file].find(use.net.steps[0].text);
            if (found != library_.visible[file].end() && found->second.net != nullptr) {
                const std::size_t told = library_.diagnostics.size();
                format->bind(body, use, *found->second.net, library_.files[file],
                             library_.diagnostics);
                library_.readable = library_.readable && library_.diagnostics.size() == told;
            }
        }
        for (lang::Net& net : body.nets) {
            bind(file, net.body);
        }
        for (lang::For& loop : body.loops) {
            bind(file, loop.body);
        }
    }

    static constexpr std::uint32_t kMissing = ~std::uint32_t{0};
    FileSource& source_;
    Library library_;
    std::map<std::string, std::uint32_t> numbers_;
    std::vector<bool> broken_;                          // by file: it has errors of its own
    std::vector<std::vector<std::uint32_t>> imported_;  // by file and import: the file's number
};

}  // namespace

bool is_movement_kind(std::string_view kind) {
    return kind == "movement" || kind == "keyframes" || kind == "clip";
}

const lang::Block* Library::block_of(const lang::Net* net) const {
    for (std::size_t i = 0; i < lowered_from.size(); ++i) {
        if (&lowered[i] == net) {
            return lowered_from[i];
        }
    }
    return nullptr;
}

const lang::Block* Library::equations_of(const lang::Net* net) const {
    const lang::Block* block = block_of(net);
    return block != nullptr && block->kind.text == "equations" ? block : nullptr;
}

Library load_library(FileSource& source, const std::string& path) {
    return Loader(source).load(path);
}

}  // namespace puppetri::scene
