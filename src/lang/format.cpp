// SPDX-License-Identifier: MIT
// The formatter changes white space and nothing else: it lays the tokens and comments of each line
// out anew, so that no comment can be lost and no meaning changed. Spacing is decided between
// neighbouring tokens; indentation by open blocks; then the columns of neighbouring statements of
// one kind are aligned like a table.
#include "puppetri/lang/format.h"

#include <algorithm>
#include <array>

#include "puppetri/base/text.h"
#include "token.h"

namespace puppetri::lang {
namespace {

constexpr std::size_t kIndent = 2, kContinuation = 4;
// A statement longer than this is no row of a table; a table wider than that is aligned in its
// first columns only.
constexpr std::size_t kMaxRow = 125, kMaxWidth = 140;
constexpr int kColumns = 6;      // of a table, at most
constexpr int kLastAligned = 4;  // what comes behind is different in every row

struct Piece {
    std::uint32_t begin = 0, end = 0;
    Kind kind = Kind::kEndOfFile;
    bool comment = false;
    bool statement_start = false;  // the first token of a statement
    bool space_before = false, is_unit = false;
};

// A part of a line that is aligned with the parts of the same column in the lines around.
struct Cell {
    int column = 0;
    std::string text;
};

struct Line {
    std::size_t indent = 0;
    std::vector<Cell> cells;
    std::string comment;
    Kind table = Kind::kEndOfFile;  // what kind of statement it is a row of; kEndOfFile: of none
    bool blank_before = false;
};

class Formatter {
 public:
    Formatter(std::string_view text, const Tokens& tokens) : text_(text) {
        bool start = true;
        std::size_t comment = 0;
        const auto add_comments = [&](std::uint32_t before) {
            for (; comment < tokens.comments.size() && tokens.comments[comment].begin < before;
                 ++comment) {
                pieces_.push_back({tokens.comments[comment].begin, tokens.comments[comment].end,
                                   Kind::kEndOfFile, true, false, true, false});
            }
        };
        for (const Token& token : tokens.list) {
            add_comments(token.begin);
            if (token.kind == Kind::kNewline || token.kind == Kind::kEndOfFile) {
                start = true;
                continue;
            }
            const bool brace = token.kind == Kind::kOpenBlock || token.kind == Kind::kCloseBlock;
            pieces_.push_back({token.begin, token.end, token.kind, false, start || brace,
                               token.space_before, token.is_unit});
            start = brace;
        }
        add_comments(static_cast<std::uint32_t>(text.size()) + 1);
        // A comment on a line of its own is indented like what comes behind it.
        bool starts = true;
        for (std::size_t i = pieces_.size(); i > 0; --i) {
            Piece& piece = pieces_[i - 1];
            piece.statement_start = piece.comment ? starts : piece.statement_start;
            starts = piece.statement_start;
        }
    }

    std::string run() {
        std::size_t begin = 0;
        while (begin < pieces_.size()) {
            std::size_t end = begin + 1;
            while (end < pieces_.size() && breaks_before(end) == 0) {
                ++end;
            }
            lay_out(begin, end);
            begin = end;
        }
        align_tables();
        return print();
    }

 private:
    std::string_view text(std::size_t i) const {
        return text_.substr(pieces_[i].begin, pieces_[i].end - pieces_[i].begin);
    }
    std::string_view between(std::size_t i) const {
        return text_.substr(pieces_[i - 1].end, pieces_[i].begin - pieces_[i - 1].end);
    }
    // Line ends between a piece and the one before.
    std::size_t breaks_before(std::size_t i) const {
        const std::string_view gap = between(i);
        return static_cast<std::size_t>(std::count(gap.begin(), gap.end(), '\n'));
    }

    // ---- one line

    void lay_out(std::size_t begin, std::size_t end) {
        Line line;
        line.blank_before = begin > 0 && breaks_before(begin) > 1 &&
                            pieces_[begin - 1].kind != Kind::kOpenBlock &&
                            pieces_[begin].kind != Kind::kCloseBlock;
        std::size_t depth = blocks_;
        for (std::size_t i = begin; i < end && pieces_[i].kind == Kind::kCloseBlock && depth > 0;
             ++i) {
            --depth;
        }
        const bool continues = !pieces_[begin].statement_start;
        line.indent = depth * kIndent + (continues ? kContinuation : 0);
        line.table = continues ? Kind::kEndOfFile : table_of(begin, end);
        line.cells.push_back({});
        question_.clear();
        question_.push_back(0);
        state_ = {};
        for (std::size_t i = begin; i < end; ++i) {
            const Piece& piece = pieces_[i];
            if (piece.comment) {
                line.comment = std::string(text(i));
                continue;
            }
            const int column =
                line.table == Kind::kEndOfFile ? 0 : column_of_piece(line.table, begin, i);
            if (column > line.cells.back().column) {
                line.cells.push_back({column, {}});
            } else if (i > begin && space_between(i)) {
                line.cells.back().text += ' ';
            }
            line.cells.back().text += text(i);
            enter(i);
        }
        if (end < pieces_.size() && !pieces_[end - 1].comment &&
            between(end).find('\\') != std::string_view::npos) {
            line.cells.back().text += " \\";
        }
        lines_.push_back(std::move(line));
    }

    void enter(std::size_t i) {
        switch (pieces_[i].kind) {
            case Kind::kOpenBlock:
                ++blocks_;
                break;
            case Kind::kCloseBlock:
                blocks_ -= blocks_ > 0 ? 1 : 0;
                break;
            case Kind::kOpenParen:
            case Kind::kOpenList:
                question_.push_back(0);
                break;
            case Kind::kCloseParen:
            case Kind::kCloseList:
                if (question_.size() > 1) {
                    question_.pop_back();
                }
                break;
            case Kind::kQuestion:
                ++question_.back();
                break;
            case Kind::kColon:
                state_.conditional_colon = question_.back() > 0;
                question_.back() -= question_.back() > 0 ? 1 : 0;
                break;
            case Kind::kMinus:
            case Kind::kPlus:
                state_.sign = is_sign(i);
                break;
            default:
                break;
        }
        if (pieces_[i].kind != Kind::kMinus && pieces_[i].kind != Kind::kPlus) {
            state_.sign = false;
        }
    }

    // ---- spaces

    static bool ends_operand(Kind kind) {
        return is_word(kind) || kind == Kind::kNumber || kind == Kind::kString ||
               kind == Kind::kQuotedName || kind == Kind::kCloseParen || kind == Kind::kCloseList;
    }
    // A minus or plus before an operand, not between two. After a word that may be a clause
    // (`priority -1`) the author's spacing tells.
    bool is_sign(std::size_t i) const {
        if (i == 0 || pieces_[i].statement_start || !ends_operand(pieces_[i - 1].kind) ||
            is_word_operator(pieces_[i - 1].kind)) {
            return true;
        }
        return is_word(pieces_[i - 1].kind) && pieces_[i].space_before && i + 1 < pieces_.size() &&
               !pieces_[i + 1].space_before;
    }

    bool space_between(std::size_t i) const {
        const Piece& a = pieces_[i - 1];
        const Piece& b = pieces_[i];
        switch (a.kind) {
            case Kind::kOpenParen:
            case Kind::kOpenList:
            case Kind::kDot:
            case Kind::kCount:
            case Kind::kTell:
            case Kind::kHear:
                return false;
            case Kind::kOpenBlock:
                return true;
            case Kind::kMinus:
            case Kind::kPlus:
                if (state_.sign) {
                    return false;
                }
                break;
            case Kind::kTimes:
            case Kind::kOver:
            case Kind::kCaret:
                return tight(i - 1) ? false : b.space_before;
            default:
                break;
        }
        switch (b.kind) {
            case Kind::kComma:
            case Kind::kSemicolon:
            case Kind::kCloseParen:
            case Kind::kCloseList:
            case Kind::kDot:
            case Kind::kTell:
            case Kind::kHear:
                return false;
            case Kind::kColon:
                return question_.back() > 0;
            case Kind::kTimes:
            case Kind::kOver:
            case Kind::kCaret:
                return tight(i) ? false : b.space_before;
            case Kind::kOpenList:
                return is_word(a.kind) || a.kind == Kind::kQuotedName ? b.space_before : true;
            case Kind::kOpenParen:
                if (is_word_operator(a.kind)) {
                    return true;
                }
                return is_word(a.kind) || a.kind == Kind::kQuotedName || a.kind == Kind::kCloseList
                           ? b.space_before && !declares(i)
                           : true;
            default:
                return true;
        }
    }

    // a*b, n/2, x^2. Not where a unit is near: 3 m/s is one number, 3 m / s divides it by s.
    bool tight(std::size_t i) const {
        const bool unit_after = i + 1 < pieces_.size() && pieces_[i + 1].is_unit;
        return !unit_after && !(pieces_[i].kind == Kind::kCaret && i > 0 && pieces_[i - 1].is_unit);
    }

    // The bracket opens parameters or the things of a rule, where a space has no meaning and is
    // taken out.
    bool declares(std::size_t i) const {
        switch (pieces_[i - 1].kind) {
            case Kind::kMutex:
            case Kind::kExactlyOne:
            case Kind::kAlternate:
            case Kind::kBounded:
            case Kind::kLive:
            case Kind::kQuasiLive:
            case Kind::kNobodyFreezes:
                return first_of_statement(i) == Kind::kRule;
            default:
                break;
        }
        if (i < 2) {
            return false;
        }
        const Kind before = pieces_[i - 2].kind;
        return (before == Kind::kNet || before == Kind::kMachine || before == Kind::kToken) &&
               pieces_[i - 2].statement_start;
    }
    Kind first_of_statement(std::size_t i) const {
        while (i > 0 && !pieces_[i].statement_start) {
            --i;
        }
        return pieces_[i].kind;
    }

    // ---- tables

    // Which table a line is a row of: one whole statement, with or without a block that ends on the
    // line.
    Kind table_of(std::size_t begin, std::size_t end) const {
        std::size_t first = begin;
        int open = 0, statements = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const Kind kind = pieces_[i].kind;
            open += kind == Kind::kOpenBlock ? 1 : (kind == Kind::kCloseBlock ? -1 : 0);
            statements += pieces_[i].statement_start && !pieces_[i].comment && open == 0 &&
                                  kind != Kind::kCloseBlock
                              ? 1
                              : 0;
            if (open < 0) {
                return Kind::kEndOfFile;
            }
        }
        const bool goes_on =
            end < pieces_.size() && !pieces_[end].comment && !pieces_[end].statement_start;
        if (open != 0 || statements != 1 || goes_on || pieces_[begin].comment) {
            return Kind::kEndOfFile;
        }
        const auto kind_at = [&](std::size_t i) {
            return i < end ? pieces_[i].kind : Kind::kEndOfFile;
        };
        if (kind_at(first) == Kind::kPublic && kind_at(first + 1) != Kind::kColon) {
            ++first;
        }
        if ((kind_at(first) == Kind::kStart || kind_at(first) == Kind::kFinish) &&
            kind_at(first + 1) == Kind::kPlace) {
            ++first;
        }
        const bool labelled =
            kind_at(first + 1) == Kind::kColon ||
            (kind_at(first + 1) == Kind::kString && kind_at(first + 2) == Kind::kColon);
        if (labelled) {
            for (std::size_t i = first; i < end; ++i) {
                if (pieces_[i].kind == Kind::kArrow) {
                    return Kind::kArrow;
                }
            }
            return Kind::kCast;
        }
        switch (kind_at(first)) {
            case Kind::kPlace:
            case Kind::kUse:
            case Kind::kRule:
            case Kind::kQuestionWord:
            case Kind::kMeasure:
                return kind_at(first);
            case Kind::kState:  // of a machine, which is a row like a place's; others are formulas
                for (std::size_t i = first; i < end; ++i) {
                    if (pieces_[i].kind == Kind::kEqual) {
                        return Kind::kEndOfFile;
                    }
                }
                return Kind::kState;
            default:
                return Kind::kEndOfFile;
        }
    }

    // The column that a piece begins or belongs to; columns never go back within a line.
    int column_of_piece(Kind table, std::size_t begin, std::size_t i) {
        int& column = state_.column;
        const Kind kind = pieces_[i].kind;
        if (i == begin) {
            column = 0;
            return column;
        }
        if (question_.size() > 1) {  // inside brackets
            return column;
        }
        const auto at_least = [&](int wanted) {
            column = std::max(column, wanted);
            return column;
        };
        const bool first_string = kind == Kind::kString && column == 0;
        switch (table) {
            case Kind::kArrow:  // NAME: | inputs | -> outputs | clauses
                if (column == 0 && pieces_[i - 1].kind == Kind::kColon) {
                    return at_least(kind == Kind::kArrow ? 2 : 1);
                }
                if (column == 2 && begins_clause(i)) {
                    return at_least(3);
                }
                return kind == Kind::kArrow ? at_least(2) : column;
            case Kind::kCast:  // NAME: | kind | { ... }
                if (column == 0 && pieces_[i - 1].kind == Kind::kColon) {
                    return at_least(1);
                }
                return kind == Kind::kOpenBlock ? at_least(2) : column;
            case Kind::kUse:  // use NET(...) | as NAME
                return kind == Kind::kAs ? at_least(1) : column;
            case Kind::kRule:  // rule NAME | caption | form
            case Kind::kQuestionWord:
            case Kind::kMeasure:
                if (first_string) {
                    return at_least(1);
                }
                return column < 2 && after_head(begin, i) ? at_least(2) : column;
            default:  // place NAME | caption | does, runs | takes | tokens | rest
                if (first_string) {
                    return at_least(1);
                }
                if (!after_head(begin, i)) {
                    return column;
                }
                switch (kind) {
                    case Kind::kDoes:
                    case Kind::kRuns:
                        return column < 2 ? at_least(2) : column;
                    case Kind::kTakes:
                        return column < 3 ? at_least(3) : column;
                    case Kind::kTokens:
                    case Kind::kStarts:
                    case Kind::kFinal:
                        return column < 4 ? at_least(4) : column;
                    case Kind::kOf:
                    case Kind::kIs:
                    case Kind::kHolds:
                    case Kind::kKeeps:
                    case Kind::kDiscipline:
                        return at_least(5);
                    default:
                        return column;
                }
        }
    }

    // Behind the outputs of a transition: two values side by side, or a clause right after the
    // arrow.
    bool begins_clause(std::size_t i) const {
        if (!is_word(pieces_[i].kind)) {
            return false;
        }
        if (pieces_[i - 1].kind != Kind::kArrow) {
            return ends_operand(pieces_[i - 1].kind);
        }
        switch (pieces_[i].kind) {
            case Kind::kPriority:
            case Kind::kWhen:
            case Kind::kWith:
            case Kind::kWhile:
            case Kind::kUnless:
            case Kind::kOn:
            case Kind::kAfter:
            case Kind::kFor:
            case Kind::kSet:
            case Kind::kOdds:
            case Kind::kRaises:
            case Kind::kTogether:
            case Kind::kSend:
            case Kind::kReceive:
            case Kind::kPoll:
                return i + 1 < pieces_.size() && breaks_before(i + 1) == 0 &&
                       !pieces_[i + 1].comment && pieces_[i + 1].kind != Kind::kPlus &&
                       pieces_[i + 1].kind != Kind::kDot;
            default:
                return false;
        }
    }

    // Behind `place NAME`, `rule NAME`, `question NAME` or `measure NAME`, the name with its
    // indices included.
    bool after_head(std::size_t begin, std::size_t i) const {
        std::size_t at = begin;
        while (at < i && pieces_[at].kind != Kind::kPlace && pieces_[at].kind != Kind::kState &&
               pieces_[at].kind != Kind::kRule && pieces_[at].kind != Kind::kQuestionWord &&
               pieces_[at].kind != Kind::kMeasure) {
            ++at;
        }
        ++at;  // the name
        if (at >= i) {
            return false;
        }
        return pieces_[i].kind != Kind::kOpenList || pieces_[i].space_before;
    }

    static std::size_t width(const std::string& text) { return count_code_points(text); }

    static std::size_t natural_width(const Line& line) {
        std::size_t out = line.indent;
        for (const Cell& cell : line.cells) {
            out += width(cell.text) + 1;
        }
        return out;
    }

    void align_tables() {
        for (Line& line : lines_) {
            if (natural_width(line) > kMaxRow) {
                line.table = Kind::kEndOfFile;
            }
        }
        std::size_t begin = 0;
        while (begin < lines_.size()) {
            std::size_t end = begin + 1;
            const Line& first = lines_[begin];
            while (end < lines_.size() && first.table != Kind::kEndOfFile &&
                   lines_[end].table == first.table && lines_[end].indent == first.indent &&
                   !lines_[end].blank_before) {
                ++end;
            }
            align(begin, end);
            begin = end;
        }
    }

    // Clauses stand two columns apart in a table, everything else one.
    static std::size_t gap_before(Kind table, int column) {
        const bool clause =
            ((table == Kind::kPlace || table == Kind::kState) && column >= 2) ||
            (table == Kind::kArrow && column >= 3) ||
            ((table == Kind::kRule || table == Kind::kQuestionWord || table == Kind::kMeasure) &&
             column >= 2);
        return clause ? 2 : 1;
    }

    void align(std::size_t begin, std::size_t end) {
        std::vector<std::string> rows;
        for (int aligned = end - begin > 1 ? kLastAligned : 0; aligned >= 0; --aligned) {
            rows = rows_of(begin, end, aligned);
            const bool fits = std::all_of(rows.begin(), rows.end(), [](const std::string& row) {
                return width(row) <= kMaxWidth;
            });
            if (fits) {
                break;
            }
        }
        for (std::size_t i = begin; i < end; ++i) {
            lines_[i].cells.assign(1, {0, std::move(rows[i - begin])});
        }
    }

    // The lines with their columns up to `aligned` below each other; 0: as they come.
    std::vector<std::string> rows_of(std::size_t begin, std::size_t end, int aligned) const {
        std::array<std::size_t, kColumns> widths{}, starts{};
        for (std::size_t i = begin; i < end; ++i) {
            const std::vector<Cell>& cells = lines_[i].cells;
            for (std::size_t c = 0; c + 1 < cells.size(); ++c) {
                std::size_t& widest = widths[static_cast<std::size_t>(cells[c].column)];
                widest = std::max(widest, width(cells[c].text));
            }
        }
        const Kind table = lines_[begin].table;
        std::size_t edge = widths[0];
        for (int c = 1; c <= aligned; ++c) {
            const auto column = static_cast<std::size_t>(c);
            starts[column] = edge + gap_before(table, c);
            edge = widths[column] > 0 ? starts[column] + widths[column] : edge;
        }
        std::vector<std::string> rows;
        for (std::size_t i = begin; i < end; ++i) {
            std::string row;
            for (const Cell& cell : lines_[i].cells) {
                if (!row.empty()) {
                    const std::size_t have = width(row),
                                      least = aligned > 0 ? gap_before(table, cell.column) : 1;
                    const std::size_t start =
                        cell.column <= aligned ? starts[static_cast<std::size_t>(cell.column)] : 0;
                    row.append(std::max(least, start > have ? start - have : 0), ' ');
                }
                row += cell.text;
            }
            rows.push_back(std::move(row));
        }
        return rows;
    }

    // ---- output

    std::string print() {
        std::string out;
        const std::vector<std::size_t> columns = comment_columns();
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            const Line& line = lines_[i];
            const std::string& body = line.cells[0].text;
            out += line.blank_before ? "\n" : "";
            out.append(line.indent, ' ');
            out += body;
            if (!line.comment.empty()) {
                if (!body.empty()) {
                    out.append(columns[i] - line.indent - width(body), ' ');
                }
                out += line.comment;
            }
            out += '\n';
        }
        return out;
    }

    // Comments at the ends of neighbouring lines stand below each other, two columns after the
    // longest.
    std::vector<std::size_t> comment_columns() const {
        std::vector<std::size_t> columns(lines_.size(), 0);
        const auto trails = [this](std::size_t i) {
            return !lines_[i].comment.empty() && !lines_[i].cells[0].text.empty();
        };
        for (std::size_t begin = 0; begin < lines_.size();) {
            std::size_t end = begin, widest = 0;
            for (;
                 end < lines_.size() && trails(end) && (end == begin || !lines_[end].blank_before);
                 ++end) {
                widest = std::max(widest, lines_[end].indent + width(lines_[end].cells[0].text));
            }
            std::fill(columns.begin() + static_cast<std::ptrdiff_t>(begin),
                      columns.begin() + static_cast<std::ptrdiff_t>(end), widest + 2);
            begin = std::max(end, begin + 1);
        }
        return columns;
    }

    struct State {
        bool sign = false;               // the last token was a sign, not an operator
        bool conditional_colon = false;  // the last colon belongs to a ?
        int column = 0;
    };

    std::string_view text_;
    std::vector<Piece> pieces_;
    std::vector<Line> lines_;
    std::vector<int> question_ = {0};  // open ? per open bracket of the line
    State state_;
    std::size_t blocks_ = 0;
};

}  // namespace

Checked<std::string> format(std::string_view text, std::string_view filename) {
    Parsed parsed = parse(text, filename);
    if (has_errors(parsed.diagnostics)) {
        return Unexpected(std::move(parsed.diagnostics));
    }
    Diagnostics none;
    Report report(parsed.file, 0, none);
    return Formatter(parsed.file.text, tokenize(parsed.file.text, report)).run();
}

}  // namespace puppetri::lang
