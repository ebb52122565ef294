// SPDX-License-Identifier: MIT
// The driver: finds statements and blocks by their line ends and braces, lets the grammar read each
// statement, and goes on after a defect with the next one, so that all defects of a file are told
// at once.
#include "puppetri/lang/parse.h"

#include <algorithm>
#include <array>

#include "build.h"
#include "complain.h"
#include "puppetri/base/text.h"

namespace puppetri::lang {
namespace {

enum class Level : std::uint8_t { kFile, kNet, kMachine, kLoop };

class Parser {
 public:
    Parser(File& file, std::uint32_t number, Diagnostics& out)
        : file_(file),
          report_(file, number, out),
          lexed_(tokenize(file.text, report_)),
          tokens_(lexed_.list) {
        kinds_.reserve(tokens_.size());
        for (const Token& token : tokens_) {
            kinds_.push_back(static_cast<char>(token.kind));
        }
    }

    void run() { body(file_.body, Level::kFile, nullptr, "the file"); }

 private:
    // ---- tokens

    Kind kind(std::uint32_t i) const {
        return tokens_[std::min<std::size_t>(i, tokens_.size() - 1)].kind;
    }
    void error(std::uint32_t at, std::string code, const std::string& element, std::string message,
               std::string remedy) {
        report_.error(tokens_[at].begin, std::max(tokens_[at].end, tokens_[at].begin + 1),
                      std::move(code), element, std::move(message), std::move(remedy));
    }

    // Where the statement that begins here ends: before a line end, a brace, or the comma of a list
    // of properties.
    std::uint32_t statement_end(std::uint32_t begin, bool commas) const {
        int open = 0;
        for (std::uint32_t i = begin;; ++i) {
            switch (kind(i)) {
                case Kind::kNewline:
                case Kind::kSemicolon:
                case Kind::kOpenBlock:
                case Kind::kCloseBlock:
                case Kind::kEndOfFile:
                    return i;
                case Kind::kOpenParen:
                case Kind::kOpenList:
                    ++open;
                    break;
                case Kind::kCloseParen:
                case Kind::kCloseList:
                    --open;
                    break;
                case Kind::kComma:
                    if (commas && open <= 0) {
                        return i;
                    }
                    break;
                default:
                    break;
            }
        }
    }

    // From an open brace to behind its partner, nothing read.
    void skip_block() {
        std::uint32_t open = 0;
        for (; kind(at_) != Kind::kEndOfFile; ++at_) {
            if (kind(at_) == Kind::kOpenBlock) {
                ++open;
            } else if (kind(at_) == Kind::kCloseBlock && --open == 0) {
                ++at_;
                return;
            }
        }
    }

    bool read(Entry entry, std::uint32_t begin, std::uint32_t end, const std::string& element) {
        if (read_statement(entry, tokens_, kinds_, begin, end, reading_)) {
            return true;
        }
        complain(entry, tokens_, begin, end, reading_, element, report_);
        return false;
    }
    Builder builder(const std::string& element) {
        Builder out(tokens_, reading_, report_);
        out.element = element;
        return out;
    }

    // ---- blocks of statements

    // True when there is one more statement at at_; false when the block is over. `opener` is the
    // block's brace; a file has none.
    bool more(const std::uint32_t* opener, const std::string& element, bool commas) {
        while (true) {
            switch (kind(at_)) {
                case Kind::kNewline:
                    ++at_;
                    break;
                case Kind::kEndOfFile:
                    if (opener != nullptr) {
                        error(*opener, "unclosed-block", element, "this brace is not closed",
                              "put } where " + element + " ends; is the file whole?");
                    }
                    return false;
                case Kind::kCloseBlock:
                    if (opener != nullptr) {
                        ++at_;
                        return false;
                    }
                    error(at_, "unmatched-brace", element, "this brace closes nothing",
                          "remove it, or look for a brace too many above");
                    ++at_;
                    break;
                case Kind::kOpenBlock:
                    error(at_, "syntax", element, "a block needs a head before its brace",
                          "write net NAME {, cast { or the like");
                    skip_block();
                    break;
                case Kind::kSemicolon:
                    if (!commas) {
                        error(at_, "invalid-character", element,
                              "a semicolon stands between the properties of a block only",
                              "put each statement on a line of its own");
                    }
                    ++at_;
                    break;
                case Kind::kComma:
                    if (commas) {
                        ++at_;
                        break;
                    }
                    return true;
                default:
                    return true;
            }
            if (report_.full()) {
                return false;
            }
        }
    }

    // After the head of a block: opens it. False (and reported) when there is no brace, or too many
    // around.
    bool open_block(std::uint32_t end, const std::string& element) {
        at_ = end;
        if (kind(at_) != Kind::kOpenBlock) {
            error(std::min(end, static_cast<std::uint32_t>(tokens_.size() - 1)), "syntax", element,
                  "'{' is missing", "put { at the end of this line, and } where the block ends");
            return false;
        }
        if (blocks_ >= kMaxNesting) {
            error(at_, "too-deep", element, "blocks are nested too deeply",
                  "take the inner ones out");
            skip_block();
            return false;
        }
        ++at_;
        ++blocks_;
        return true;
    }
    void close_block() { --blocks_; }

    bool at_line_start(std::uint32_t i) const {
        const std::uint32_t begin = tokens_[i].begin;
        return begin == 0 || file_.text[begin - 1] == '\n';
    }

    // What can only stand in a file, seen at the left margin inside a net: its brace was forgotten.
    bool brace_forgotten(std::uint32_t begin) const {
        switch (kind(begin)) {
            case Kind::kNet:
            case Kind::kMachine:
            case Kind::kCast:
            case Kind::kScene:
            case Kind::kImport:
            case Kind::kLanguage:
                return at_line_start(begin) && kind(begin + 1) != Kind::kColon;
            default:
                return false;
        }
    }

    void body(Body& out, Level level, const std::uint32_t* opener, const std::string& element) {
        while (!report_.full() && more(opener, element, false)) {
            if (level != Level::kFile && brace_forgotten(at_)) {
                error(at_, "unclosed-block", element, "'}' is missing before this line",
                      "put } where " + element + " ends");
                return;
            }
            const std::uint32_t begin = at_;
            const std::uint32_t end = statement_end(begin, false);
            at_ = end;
            if (begin == end) {  // only a brace can be here
                ++at_;
                continue;
            }
            statement(out, level, begin, end, element);
        }
    }

    // The kind of the statement, by its first words, when the grammar could not read it.
    NodeKind guess(std::uint32_t begin) const {
        switch (kind(begin)) {
            case Kind::kNet:
            case Kind::kMachine:
                return NodeKind::kNet;
            case Kind::kFor:
                return NodeKind::kFor;
            case Kind::kCast:
                return NodeKind::kCast;
            case Kind::kEnum:
                return NodeKind::kEnum;
            case Kind::kEnd:
                return NodeKind::kEnds;
            default:
                return NodeKind::kBlock;
        }
    }

    void statement(Body& out, Level level, std::uint32_t begin, std::uint32_t end,
                   const std::string& element) {
        const bool brace = kind(end) == Kind::kOpenBlock;
        const bool good = read_statement(Entry::kStatement, tokens_, kinds_, begin, end, reading_);
        NodeKind which = good ? reading_.nodes[0].kind : guess(begin);
        const bool is_block = which == NodeKind::kBlock;
        if (good && is_block && (!brace || misspelt_block(begin))) {
            // Two names side by side are the head of a block, or a slip.
            complain(Entry::kStatement, tokens_, begin, end, reading_, element, report_);
            which = guess(begin);
            if (brace) {
                recover(misspelt_net(begin) ? NodeKind::kNet : which, level, begin, end);
            }
            return;
        }
        if (!good) {
            complain(Entry::kStatement, tokens_, begin, end, reading_, element, report_);
            complain_on(begin, end, element);
            if (brace) {
                recover(which, level, begin, end);
            }
            return;
        }
        if (!belongs(which, level, begin, element)) {
            if (brace) {
                recover(which, level, begin, end);
            }
            return;
        }
        build(out, which, level, end, element);
        if (kind(at_) == Kind::kOpenBlock && at_ == end) {
            error(at_, "syntax", element, "no block can follow this statement",
                  "remove the braces, or the statement before");
            skip_block();
        }
    }

    // A word that can begin a clause of a place or of a transition, or a slip of one.
    bool begins_clause(const Token& token, bool also_misspelt) const {
        static const std::vector<std::string> words = {
            "does",   "runs",     "takes",    "tokens",  "holds", "keeps", "discipline",
            "of",     "is",       "priority", "when",    "with",  "while", "unless",
            "on",     "after",    "memory",   "servers", "for",   "set",   "odds",
            "raises", "together", "send",     "receive", "poll"};
        if (!is_word(token.kind)) {
            return false;
        }
        const std::string_view word =
            std::string_view(file_.text).substr(token.begin, token.end - token.begin);
        if (std::find(words.begin(), words.end(), word) != words.end()) {
            return true;
        }
        return also_misspelt && token.kind == Kind::kWord && word.size() >= 4 &&
               !nearest_name(word, words).empty();
    }

    // The grammar has stopped at a word that begins no clause of this place or transition. Leaves
    // that clause out and reads on, so that the defects behind it are told too.
    void complain_on(std::uint32_t begin, std::uint32_t end, const std::string& element) {
        std::vector<Token> rest(tokens_.begin() + begin,
                                tokens_.begin() + end + 1);  // with what ends it
        std::uint32_t stuck = reading_.furthest - begin;
        const bool labelled =
            rest.size() > 2 && (rest[1].kind == Kind::kColon || rest[2].kind == Kind::kColon);
        if (rest[0].kind != Kind::kPlace && rest[0].kind != Kind::kState &&
            rest[0].kind != Kind::kPublic && !labelled) {
            return;
        }
        while (!report_.full() && stuck > 1 && stuck + 1 < rest.size() &&
               rest[stuck].kind == Kind::kWord) {
            int open = 0;
            std::uint32_t next = stuck + 1;
            for (; next + 1 < rest.size(); ++next) {
                const Kind k = rest[next].kind;
                open += k == Kind::kOpenParen || k == Kind::kOpenList ? 1 : 0;
                open -= k == Kind::kCloseParen || k == Kind::kCloseList ? 1 : 0;
                if (open == 0 && begins_clause(rest[next], next > stuck + 1)) {
                    break;
                }
            }
            if (next + 1 >= rest.size()) {
                return;
            }
            rest.erase(rest.begin() + stuck, rest.begin() + next);
            std::vector<char> kinds;
            for (const Token& token : rest) {
                kinds.push_back(static_cast<char>(token.kind));
            }
            const auto size = static_cast<std::uint32_t>(rest.size() - 1);
            if (read_statement(Entry::kStatement, rest, kinds, 0, size, reading_) ||
                reading_.furthest < stuck) {
                return;
            }
            complain(Entry::kStatement, rest, 0, size, reading_, element, report_);
            stuck = reading_.furthest;
        }
    }

    // Reads the block of a head that could not be read, or has no place here, to tell its defects
    // too.
    void recover(NodeKind which, Level level, std::uint32_t begin, std::uint32_t end) {
        at_ = end;
        Body dropped;
        const bool named = begin + 1 < end && is_word(kind(begin + 1));
        const std::string name = named ? std::string(text(begin + 1)) : "";
        switch (which) {
            case NodeKind::kNet:
                inner_body(dropped, level_of(begin), end, "net " + name);
                break;
            case NodeKind::kFor:
                inner_body(dropped, inner(level), end, "for " + name);
                break;
            case NodeKind::kCast:
                cast(dropped, end);
                break;
            default:
                skip_block();
        }
    }
    static Level inner(Level level) { return level == Level::kFile ? Level::kLoop : level; }
    Level level_of(std::uint32_t begin) const {
        static const std::vector<std::string> known = {"machine"};
        const bool machine =
            kind(begin) == Kind::kMachine || !nearest_name(text(begin), known).empty();
        return machine ? Level::kMachine : Level::kNet;
    }

    bool misspelt_net(std::uint32_t begin) const {
        static const std::vector<std::string> known = {"net", "machine"};
        return kind(begin) == Kind::kWord && !nearest_name(text(begin), known).empty();
    }
    // A head like a block's whose kind was meant to be a statement's.
    bool misspelt_block(std::uint32_t begin) const {
        static const std::vector<std::string> known = {"net", "machine", "cast", "enum"};
        return kind(begin) == Kind::kWord && !nearest_name(text(begin), known).empty();
    }
    std::string_view text(std::uint32_t i) const {
        return std::string_view(file_.text)
            .substr(tokens_[i].begin, tokens_[i].end - tokens_[i].begin);
    }

    bool belongs(NodeKind which, Level level, std::uint32_t begin, const std::string& element) {
        if (which == NodeKind::kMachineState && level != Level::kMachine) {
            error(begin, "syntax", element, "'=' is missing: a state of a net is a formula",
                  "write state NAME = A and B; states of their own are those of a machine");
            return false;
        }
        if (which == NodeKind::kPlace && level == Level::kMachine) {
            error(begin, "misplaced", element, "a machine has states, and no places",
                  "write state NAME, or make this a net");
            return false;
        }
        if (level == Level::kFile) {
            return true;
        }
        switch (which) {
            case NodeKind::kNet:
            case NodeKind::kCast:
            case NodeKind::kHeader:
            case NodeKind::kImport:
            case NodeKind::kBlock:
            case NodeKind::kEvents:
                error(begin, "misplaced", element,
                      "'" + std::string(text(begin)) + "' cannot stand inside " + element,
                      "put it outside; is a } missing above?");
                return false;
            default:
                return true;
        }
    }

    void build(Body& out, NodeKind which, Level level, std::uint32_t end,
               const std::string& element) {
        Builder b = builder(element);
        switch (which) {
            case NodeKind::kPlace:
                out.places.push_back(b.place(0));
                break;
            case NodeKind::kTransition:
                out.transitions.push_back(b.transition(0));
                if (out.transitions.back().poll && level != Level::kMachine) {
                    report_.error(out.transitions.back().poll.span, "misplaced", element,
                                  "'poll' is a word of machines",
                                  "write event tick every 40 ms, and `on tick` here");
                }
                break;
            case NodeKind::kState:
                out.states.push_back(b.state(0));
                break;
            case NodeKind::kMachineState:
                out.places.push_back(b.place(0));
                break;
            case NodeKind::kChannel:
                out.channels.push_back(b.channel(0));
                break;
            case NodeKind::kData:
                out.data.push_back(b.data(0));
                break;
            case NodeKind::kToken:
                out.token_types.push_back(b.token_type(0));
                break;
            case NodeKind::kEvent:
                out.events.push_back(b.event(0));
                break;
            case NodeKind::kEvents:
                out.event_files.push_back(b.event_file(0));
                break;
            case NodeKind::kUse: {
                Use use = b.use(0);
                if (!use.path.empty()) {
                    use_file(use, end);
                }
                out.uses.push_back(std::move(use));
                break;
            }
            case NodeKind::kRule:
                out.rules.push_back(b.rule(0));
                break;
            case NodeKind::kQuestion:
                out.questions.push_back(b.question(0));
                break;
            case NodeKind::kMeasure:
                out.measures.push_back(b.measure(0));
                break;
            case NodeKind::kHeader:
                b.header(0, file_.header);
                break;
            case NodeKind::kImport:
                file_.imports.push_back(b.import(0));
                break;
            case NodeKind::kCast:
                cast(out, end);
                break;
            case NodeKind::kNet: {
                Net net = b.net(0);
                inner_body(net.body, net.is_machine ? Level::kMachine : Level::kNet, end,
                           (net.is_machine ? "machine " : "net ") + net.name.text);
                extend(net.span);
                out.nets.push_back(std::move(net));
                break;
            }
            case NodeKind::kFor: {
                For loop = b.loop(0);
                inner_body(loop.body, inner(level), end, "for " + loop.variable.text);
                extend(loop.span);
                out.loops.push_back(std::move(loop));
                break;
            }
            case NodeKind::kEnum: {
                Enumeration enumeration = b.enumeration(0);
                items(Entry::kEnumValue, end, "enum " + enumeration.name.text,
                      [&](Builder& item) { enumeration.values.push_back(item.enum_value(0)); });
                extend(enumeration.span);
                out.enumerations.push_back(std::move(enumeration));
                break;
            }
            case NodeKind::kEnds: {
                End ends;
                ends.span = b.span(0);
                items(Entry::kFormula, end, "end",
                      [&](Builder& item) { ends.formulas.push_back(item.formula(0)); });
                extend(ends.span);
                out.ends.push_back(std::move(ends));
                break;
            }
            default: {
                Block block = b.block(0);
                properties(block.properties, end, block.kind.text + " " + block.name.text);
                extend(block.span);
                out.blocks.push_back(std::move(block));
            }
        }
    }

    // use "legs.tookima" as legs { LEFT_LEG: ana.left_leg }: an import of the file's net, and its
    // arguments one by line.
    void use_file(Use& use, std::uint32_t end) {
        const bool known =
            std::any_of(file_.imports.begin(), file_.imports.end(), [&](const Import& import) {
                return import.path == use.path && import.names.size() == 1 &&
                       import.names[0].text == use.net.steps[0].text;
            });
        if (!known) {
            file_.imports.push_back({{use.net.steps[0]}, use.path, use.net.span, use.net.span});
        }
        if (kind(end) != Kind::kOpenBlock) {
            return;
        }
        std::vector<Property> given;
        const std::string element = "use of " + use.path;
        properties(given, end, element);
        extend(use.span);
        for (Property& p : given) {
            if (p.name.steps.size() != 1 || p.values.size() != 2 ||
                p.values[0].kind != ExprKind::kSymbol || p.values[0].text != ":" ||
                p.has_children) {
                report_.error(p.span, "syntax", element,
                              "this is no binding of a name of the file to something of the scene",
                              "write NAME: VALUE");
                continue;
            }
            use.args.push_back({std::move(p.name.steps[0]), std::move(p.values[1])});
        }
    }

    // A block's span goes to its closing brace.
    void extend(Span& span) const {
        if (at_ > 0) {
            span.end = std::max(span.end, tokens_[at_ - 1].end);
        }
    }

    void inner_body(Body& out, Level level, std::uint32_t end, const std::string& element) {
        if (open_block(end, element)) {
            const std::uint32_t opener = at_ - 1;
            body(out, level, &opener, element);
            close_block();
        }
    }

    template <class F>
    void items(Entry entry, std::uint32_t head_end, const std::string& element, F add) {
        if (!open_block(head_end, element)) {
            return;
        }
        const std::uint32_t opener = at_ - 1;
        while (!report_.full() && more(&opener, element, true)) {
            const std::uint32_t begin = at_;
            at_ = statement_end(begin, true);
            if (read(entry, begin, at_, element)) {
                Builder item = builder(element);
                add(item);
            } else if (kind(at_) == Kind::kOpenBlock) {
                skip_block();
            }
        }
        close_block();
    }

    void cast(Body& out, std::uint32_t head_end) {
        items(Entry::kMember, head_end, "cast", [&](Builder& item) {
            CastMember member = item.member(0);
            if (kind(at_) == Kind::kOpenBlock) {
                properties(member.properties, at_, member.name.text);
                extend(member.span);
            }
            out.cast.push_back(std::move(member));
        });
    }

    void properties(std::vector<Property>& out, std::uint32_t head_end,
                    const std::string& element) {
        items(Entry::kProperty, head_end, element, [&](Builder& item) {
            Property property = item.property(0);
            if (kind(at_) == Kind::kOpenBlock) {
                property.has_children = true;
                properties(property.children, at_, element);
                extend(property.span);
            }
            out.push_back(std::move(property));
        });
    }

    File& file_;
    Report report_;
    Tokens lexed_;
    const std::vector<Token>& tokens_;
    std::vector<char> kinds_;
    Reading reading_;
    std::uint32_t at_ = 0;
    std::uint32_t blocks_ = 0;
};

std::vector<std::uint32_t> find_lines(std::string_view text) {
    std::vector<std::uint32_t> out = {0};
    for (std::size_t i = text.find('\n'); i != std::string_view::npos; i = text.find('\n', i + 1)) {
        out.push_back(static_cast<std::uint32_t>(i + 1));
    }
    return out;
}

// Anywhere, also inside of texts and comments: nobody sees them, and terminals act on them.
void tell_control_characters(const File& file, std::uint32_t number, Diagnostics& out) {
    constexpr char kDigits[] = "0123456789abcdef";
    Report report(file, number, out);
    for (std::size_t i = 0; i < file.text.size() && !report.full(); ++i) {
        const char c = file.text[i];
        const bool line_end = c == '\r' && i + 1 < file.text.size() && file.text[i + 1] == '\n';
        if (is_control_character(c) && !line_end) {
            const auto at = static_cast<std::uint32_t>(i);
            const auto code = static_cast<unsigned char>(c);
            report.error(at, at + 1, "invalid-character", "",
                         std::string("a control character (0x") + kDigits[code >> 4] +
                             kDigits[code & 15] + ")",
                         "remove it; is this a text file?");
        }
    }
}

}  // namespace

Parsed open_text(std::string_view text, std::string_view filename, std::uint32_t file) {
    Parsed out;
    out.file.filename = std::string(filename);
    const auto whole_file = [&](std::string code, std::string message, std::string remedy) {
        out.diagnostics.push_back({Severity::kError,
                                   std::move(code),
                                   {out.file.filename, 0, 0, 1},
                                   "",
                                   std::move(message),
                                   std::move(remedy)});
    };
    if (text.size() > kMaxFileBytes) {
        whole_file("file-too-large", "this file has more than 16 MiB",
                   "is it a scene? Split it, and import the parts");
        return out;
    }
    if (text.substr(0, 3) == "\xEF\xBB\xBF") {
        text.remove_prefix(3);
    }
    out.file.text = std::string(text);
    out.file.line_starts = find_lines(text);
    if (const std::optional<std::size_t> bad = find_invalid_utf8(text)) {
        const auto at = static_cast<std::uint32_t>(*bad);
        Report(out.file, file, out.diagnostics)
            .error(at, at + 1, "invalid-utf8", "", "this is not UTF-8 text",
                   "save the file as UTF-8");
    }
    return out;
}

Parsed parse(std::string_view text, std::string_view filename, std::uint32_t file) {
    Parsed out = open_text(text, filename, file);
    if (has_errors(out.diagnostics)) {
        return out;
    }
    tell_control_characters(out.file, file, out.diagnostics);
    Parser(out.file, file, out.diagnostics).run();
    std::stable_sort(out.diagnostics.begin(), out.diagnostics.end(),
                     [](const Diagnostic& a, const Diagnostic& b) {
                         return std::pair(a.where.line, a.where.column) <
                                std::pair(b.where.line, b.where.column);
                     });
    return out;
}

std::span<const std::string_view> keywords() { return kKeywords; }

}  // namespace puppetri::lang
