// SPDX-License-Identifier: MIT
// Cellular automata: a row, ring, grid or torus of cells that all change at once. The states of the
// cells are data, and one transition sets all of them in one firing, from the values before it: the
// update is synchronous by the very rule of assignments. Cells that are figures have a place for
// each state besides, in which the state's movement is performed; their tokens follow the data in
// the same instant.
//   cells wave {
//     ring 40
//     every 0.4 s
//     sitting
//     rising does me.stand_up()
//     sitting -> rising when left = rising
//     starts rising at 1
//   }
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "cell_grid.h"
#include "ending.h"
#include "kinds.h"
#include "line.h"
#include "literal.h"
#include "make.h"
#include "states.h"

namespace puppetri::notation {
namespace {

using lang::Expr;
using lang::ExprKind;
using lang::Op;

constexpr std::int64_t kMostCells = 10'000;
constexpr int kMostRadius = 10;
constexpr std::size_t kMostNodes = 2'000'000;  // of the formulas of all cells
// Above what scenes use, so that the figures of one instant follow before anything else happens,
// in a settled order: the order changes nothing, and provers need not try all of them.
constexpr std::int64_t kFollows = 1'000'000;
constexpr std::int64_t kOrders = 64;
// When the figures have followed the last step.
constexpr std::int64_t kEnds = kFollows - 1;
constexpr const char* kGenerations = "cells_generations";

constexpr std::string_view kStateForm =
    "NAME \"caption\" shown \"#\" does me.MOVEMENT takes TIME, or NAME continues STATE";
constexpr std::string_view kRuleForm = "FROM -> TO when CONDITION";
constexpr std::string_view kStartForm = "starts STATE at CELL, or at [CELL, CELL]";

struct Direction {
    std::string_view name;
    CellGrid::Offset offset;
};
constexpr Direction kDirections[] = {
    {"me", {0, 0}},        {"left", {-1, 0}},      {"right", {1, 0}},
    {"up", {0, -1}},       {"down", {0, 1}},       {"up_left", {-1, -1}},
    {"up_right", {1, -1}}, {"down_left", {-1, 1}}, {"down_right", {1, 1}},
};

class Cells {
 public:
    Cells(const lang::Block& block, const lang::File& file, Lowered& out)
        : block_(block), teller_(block, file, out), body_(out.net.body) {}

    void lower() {
        if (!has_plain_lines(block_, teller_)) {
            return;
        }
        const auto each = [this](const auto& wanted, const auto& read) {
            each_line(block_, teller_, wanted, read);
        };
        each(is_setting, [this](Line& line) { setting(line); });
        each(
            [](const lang::Property& p) {
                return !is_setting(p) && !has_arrow(p) && !is_start(p) && !is_ending(p);
            },
            [this](Line& line) { state(line); });
        each(is_ending, [this](Line& line) {
            read_count(line, "generations", kGenerations, teller_, ending_);
        });
        if (!good()) {
            return;
        }
        cells_.assign(static_cast<std::size_t>(grid_.columns * grid_.rows), 0);
        each(has_arrow, [this](Line& line) { rule(line); });
        each(is_start, [this](Line& line) { start(line); });
        make();
        make_ways("cells", ending_, kEnds, teller_, body_);
    }

 private:
    struct State {
        lang::Name name;
        char shown = 0;
        Expr does;
        lang::Duration takes;
        lang::Path continues;   // the figure goes on with what it does in that state
        std::size_t place = 0;  // the state whose place the figure is in
        lang::Span span;
        bool there = false;  // from the start
    };
    struct Rule {
        std::size_t from = 0, to = 0;
        Expr when;
        lang::Span span;
    };

    static bool named(const lang::Property& p, std::initializer_list<std::string_view> names) {
        return p.name.steps.size() == 1 && !has_arrow(p) &&
               std::find(names.begin(), names.end(), p.name.steps[0].text) != names.end();
    }
    static bool is_setting(const lang::Property& p) {
        return named(p, {"row", "ring", "grid", "torus", "every", "neighbours", "outside",
                         "figures", "wolfram"});
    }
    static bool is_start(const lang::Property& p) { return named(p, {"starts", "pattern"}); }

    void setting(Line& line) {
        const std::string& what = line.name().steps[0].text;
        if (what == "every") {
            if (const Expr* e = line.value("the time of a step")) {
                period_ = *e;
            }
        } else if (what == "neighbours") {
            neighbours(line);
        } else if (what == "outside") {
            if (const lang::Path* path = line.path("a state")) {
                outside_ = *path;
            }
        } else if (what == "figures") {
            if (const Expr* e = line.value("figures")) {
                figures_ = *e;
            }
        } else if (what == "wolfram") {
            if (const Expr* e = line.value("the number of a rule")) {
                wolfram_ = literal_whole(*e, 0, 255, "the number of an elementary rule", teller_);
                wolfram_span_ = line.span();
            }
        } else {
            shape(line, what);
        }
        line.finish("ring 40, every 1 s, neighbours 1, outside STATE, figures [ana, rui]");
    }

    void shape(Line& line, const std::string& what) {
        if (grid_.columns != 0) {
            teller_.error("name-twice", line.span(), "the shape of the cells is said twice",
                          "keep one of the lines");
        }
        grid_.wraps = what == "ring" || what == "torus";
        grid_.flat = what == "grid" || what == "torus";
        const Expr* e = line.value(grid_.flat ? "columns and rows" : "the number of cells");
        if (e == nullptr) {
            return;
        }
        if (grid_.flat && (e->kind != ExprKind::kTuple || e->args.size() != 2)) {
            teller_.error("syntax", e->span, "a " + what + " has columns and rows",
                          "write " + what + " (40, 30)");
            return;
        }
        const auto columns =
            literal_whole(grid_.flat ? e->args[0].value : *e, 1, kMostCells,
                          grid_.flat ? "the number of columns" : "the number of cells", teller_);
        const auto rows = grid_.flat ? literal_whole(e->args[1].value, 1, kMostCells,
                                                     "the number of rows", teller_)
                                     : std::optional<std::int64_t>(1);
        if (columns && rows && *columns * *rows > kMostCells) {
            teller_.error("net-too-large", e->span,
                          "more than " + std::to_string(kMostCells) + " cells",
                          "write fewer columns or rows");
        } else if (columns && rows) {
            grid_.columns = *columns;
            grid_.rows = *rows;
        }
        shape_span_ = line.span();
    }

    void neighbours(Line& line) {
        if (line.word("moore")) {
            return;
        }
        if (line.word("von_neumann")) {
            grid_.diamond = true;
        } else if (const Expr* e = line.value("a distance, moore or von_neumann")) {
            grid_.radius = static_cast<int>(
                literal_whole(*e, 1, kMostRadius, "the distance of neighbours", teller_)
                    .value_or(1));
            grid_.diamond = line.word("von_neumann");
        }
    }

    void state(Line& line) {
        State made{.name = line.name().steps[0],
                   .does = {},
                   .takes = {},
                   .continues = {},
                   .span = line.span()};
        lang::Caption caption = line.caption();
        while (!line.done()) {
            if (line.word("shown")) {
                const lang::Caption text = line.caption();
                if (text.text.size() != 1) {
                    teller_.error("syntax", line.span(),
                                  "a state is shown as one character of a pattern",
                                  "write " + made.name.text + " shown \"#\"");
                } else {
                    made.shown = text.text[0];
                }
            } else if (line.clause("does", "a movement of me", made.does) ||
                       line.takes(made.takes)) {
                continue;
            } else if (line.word("continues")) {
                if (const lang::Path* path = line.path("the name of a state")) {
                    made.continues = *path;
                }
            } else {
                line.finish(kStateForm);
            }
        }
        captions_.push_back(std::move(caption));
        const std::string& name = made.name.text;
        if (find(name) != nullptr) {
            teller_.error("name-twice", made.span, "there is already a state " + name,
                          "choose another name");
            return;
        }
        for (const Direction& d : kDirections) {
            if (name == d.name || name == "count" || name == "cell") {
                teller_.error("name-twice", made.span,
                              name + " means a cell in the rules of this block",
                              "choose another name for the state");
                return;
            }
        }
        made.place = states_.size();
        if (!made.continues.empty()) {
            const auto before = state_of(made.continues);  // in a line above this one
            made.place = before ? states_[*before].place : made.place;
            if (made.does || made.takes.kind != lang::DurationKind::kDefault) {
                teller_.error("syntax", made.span,
                              "a state that continues another has no movement of its own",
                              "remove `continues`, or `does` and `takes`");
            }
        }
        states_.push_back(std::move(made));
    }

    bool good() {
        if (grid_.columns == 0) {
            if (shape_span_ == lang::Span{}) {
                teller_.error("no-cells", block_.name.span, "there are no cells",
                              "write ring 40, row 40, torus (40, 30) or grid (40, 30)");
            }
            return false;
        }
        if (!period_) {
            teller_.error("no-period", block_.name.span, "nothing says how long a step is",
                          "write every 1 s");
            return false;
        }
        if (states_.size() < 2) {
            teller_.error("no-states", block_.name.span, "cells have two states or more",
                          "give each a line of its own; cells begin in the first");
            return false;
        }
        for (std::size_t s = 0; s < states_.size(); ++s) {
            if (states_[s].shown == 0 && s < 2) {
                states_[s].shown = s == 0 ? '.' : '#';
            }
        }
        if (!outside_.empty() && !state_of(outside_)) {
            return false;
        }
        grid_.outside = outside_.empty() ? states_[0].name.text : outside_.steps[0].text;
        if (grid_.wraps && !outside_.empty()) {
            teller_.warn("no-outside", outside_.span, "a ring or torus has no outside",
                         "remove the line");
        }
        if (wolfram_ && (states_.size() != 2 || grid_.flat)) {
            teller_.error("wolfram", wolfram_span_,
                          "the numbers of elementary rules are for rows and rings of two states",
                          "write the rule in lines: FROM -> TO when CONDITION");
            return false;
        }
        return true;
    }

    const State* find(std::string_view name) const {
        for (const State& s : states_) {
            if (s.name.text == name) {
                return &s;
            }
        }
        return nullptr;
    }

    std::optional<std::size_t> state_of(const lang::Path& path) {
        const State* s = path.steps.size() == 1 ? find(path.steps[0].text) : nullptr;
        if (s == nullptr) {
            teller_.error("unknown-name", path.span, "cells have no state " + lang::to_text(path),
                          "give it a line of its own: " + lang::to_text(path));
            return std::nullopt;
        }
        return static_cast<std::size_t>(s - states_.data());
    }

    void rule(Line& line) {
        line.symbol("->");
        const lang::Path* to = line.path("the name of a state");
        if (to == nullptr) {
            return;
        }
        const auto before = state_of(line.name()), after = state_of(*to);
        Rule made{.when = {}, .span = line.span()};
        line.clause("when", "a condition", made.when);
        line.finish(kRuleForm);
        if (!before || !after) {
            return;
        }
        if (wolfram_) {
            teller_.error("wolfram", line.span(), "there is a numbered rule already",
                          "remove one of them");
        }
        made.from = *before;
        made.to = *after;
        if (made.when) {
            const auto errors = errors_;
            read_at(made.when, 0, 0);  // tells what is wrong with it, once
            if (errors != errors_) {
                return;
            }
        }
        rules_.push_back(std::move(made));
    }

    std::optional<std::size_t> cell_of(const Expr& e) {
        const bool pair = grid_.flat && e.kind == ExprKind::kTuple && e.args.size() == 2;
        if (grid_.flat && !pair) {
            teller_.error("syntax", e.span, "a cell is named by its column and row",
                          "write (3, 2): columns from the left, rows from above, both from 1");
            return std::nullopt;
        }
        const auto column = literal_whole(pair ? e.args[0].value : e, 1, grid_.columns,
                                          "the column of a cell", teller_);
        const auto row =
            pair ? literal_whole(e.args[1].value, 1, grid_.rows, "the row of a cell", teller_)
                 : std::optional<std::int64_t>(1);
        if (!column || !row) {
            return std::nullopt;
        }
        return static_cast<std::size_t>((*row - 1) * grid_.columns + *column - 1);
    }

    void start(Line& line) {
        if (line.name().steps[0].text == "pattern") {
            if (const Expr* e = line.value("a list of texts")) {
                pattern(*e);
            }
            line.finish("pattern [\"..#\", \"#..\"]");
            return;
        }
        const lang::Path* path = line.path("the name of a state");
        const auto state = path != nullptr ? state_of(*path) : std::nullopt;
        if (!state) {
            return;
        }
        states_[*state].there = true;
        if (!line.word("at")) {
            teller_.error("syntax", line.span(), "it does not say which cells",
                          "write " + std::string(kStartForm));
            return;
        }
        const Expr* e = line.value("a cell");
        if (e == nullptr) {
            return;
        }
        const auto put = [&](const Expr& which) {
            if (const auto cell = cell_of(which)) {
                cells_[*cell] = *state;
            }
        };
        if (e->kind == ExprKind::kList) {
            for (const lang::Argument& a : e->args) {
                put(a.value);
            }
        } else {
            put(*e);
        }
        line.finish(kStartForm);
    }

    void pattern(const Expr& e) {
        std::vector<const Expr*> lines;
        if (e.kind == ExprKind::kList) {
            for (const lang::Argument& a : e.args) {
                lines.push_back(&a.value);
            }
        } else {
            lines.push_back(&e);
        }
        if (lines.size() > static_cast<std::size_t>(grid_.rows)) {
            teller_.error("out-of-range", e.span, "the pattern has more lines than there are rows",
                          "leave lines out, or make the grid higher");
            return;
        }
        for (std::size_t row = 0; row < lines.size(); ++row) {
            const Expr& text = *lines[row];
            if (text.kind != ExprKind::kString ||
                text.text.size() > static_cast<std::size_t>(grid_.columns)) {
                teller_.error("out-of-range", text.span,
                              "a line of a pattern is a text of at most " +
                                  std::to_string(grid_.columns) + " characters",
                              "write one character for each cell");
                return;
            }
            for (std::size_t column = 0; column < text.text.size(); ++column) {
                const auto s = std::find_if(
                    states_.begin(), states_.end(),
                    [&](const State& state) { return state.shown == text.text[column]; });
                if (s == states_.end()) {
                    teller_.error("unknown-name", text.span,
                                  std::string("no state is shown as '") + text.text[column] + "'",
                                  "write `shown \"x\"` behind a state");
                    return;
                }
                s->there = true;
                cells_[row * static_cast<std::size_t>(grid_.columns) + column] =
                    static_cast<std::size_t>(s - states_.begin());
            }
        }
    }

    Expr wrong(lang::Span span, std::string message, std::string remedy) {
        teller_.error("cell-expected", span, std::move(message), std::move(remedy));
        ++errors_;
        return make_bool(false, span);
    }

    // A condition as it is for this cell: names of neighbours become the data of cells.
    Expr read_at(const Expr& e, std::int64_t column, std::int64_t row) {
        if (e.kind == ExprKind::kPath && e.path.steps.size() == 1 &&
            e.path.steps[0].index.empty()) {
            for (const Direction& d : kDirections) {
                if (e.path.steps[0].text == d.name) {
                    if (!grid_.flat && d.offset.down != 0) {
                        return wrong(e.span, "a row of cells has no neighbours above and below",
                                     "write left and right, or use a grid");
                    }
                    return grid_.state(column, row, d.offset, e.span);
                }
            }
            return e;
        }
        if (e.kind == ExprKind::kCall && e.path.steps.size() == 1 &&
            e.path.steps[0].text == "count") {
            if (e.args.size() != 1 || e.args[0].value.kind != ExprKind::kPath ||
                !known(e.args[0].value.path)) {
                return wrong(e.span, "count asks how many neighbours are in a state",
                             "write count(" + states_[1].name.text + ")");
            }
            return grid_.count(column, row, e.args[0].value.path, e.span);
        }
        if (e.kind == ExprKind::kCall && e.path.steps.size() == 1 &&
            e.path.steps[0].text == "cell") {
            std::int64_t by[2] = {0, 0};
            bool fine = e.args.size() == (grid_.flat ? 2u : 1u);
            for (std::size_t i = 0; fine && i < e.args.size(); ++i) {
                const auto n = literal_number(e.args[i].value);
                fine = n && n->whole() && std::abs(n->numerator) <= kMostRadius;
                by[i] = fine ? n->numerator : 0;
            }
            if (!fine) {
                return wrong(e.span, "this is no cell nearby",
                             grid_.flat ? "write cell(2, -1): two to the right, one up"
                                        : "write cell(2): two to the right; cell(-2): to the left");
            }
            return grid_.state(column, row, {static_cast<int>(by[0]), static_cast<int>(by[1])},
                               e.span);
        }
        Expr out = e;
        for (std::size_t i = 0; i < e.args.size(); ++i) {
            out.args[i].value = read_at(e.args[i].value, column, row);
        }
        return out;
    }

    static std::size_t nodes(const Expr& e) {
        std::size_t sum = 1;
        for (const lang::Argument& a : e.args) {
            sum += nodes(a.value);
        }
        return sum;
    }

    bool known(const lang::Path& path) const {
        return path.steps.size() == 1 && find(path.steps[0].text) != nullptr;
    }

    Expr state_value(std::size_t state, lang::Span span) const {
        return make_reference(states_[state].name.text, span);
    }

    // What the cell is in the next step: the first line that applies, else what it is.
    Expr next(std::int64_t column, std::int64_t row) {
        Expr me = grid_.state(column, row, {}, block_.name.span);
        if (wolfram_) {
            return elementary(column, row);
        }
        Expr value = me;
        for (std::size_t i = rules_.size(); i-- > 0;) {
            const Rule& r = rules_[i];
            Expr applies = make_binary(Op::kEqual, me, state_value(r.from, r.span));
            if (r.when) {
                applies = make_both(std::move(applies), read_at(r.when, column, row));
            }
            value = make_choice(std::move(applies), state_value(r.to, r.span), std::move(value));
        }
        return value;
    }

    // Bit 4 * left + 2 * me + right of the number, as a decision of at most seven questions.
    // Source  S. Wolfram, "Statistical mechanics of cellular automata", Rev. Mod. Phys. 55 (1983).
    Expr elementary(std::int64_t column, std::int64_t row) {
        const lang::Span span = wolfram_span_;
        const auto is_one = [&](int right) {
            return make_binary(Op::kEqual, grid_.state(column, row, {right, 0}, span),
                               state_value(1, span));
        };
        const auto leaf = [&](std::int64_t bit) {
            return state_value((*wolfram_ >> bit) & 1 ? 1 : 0, span);
        };
        const auto by_right = [&](std::int64_t high) {
            return make_choice(is_one(1), leaf(high + 1), leaf(high));
        };
        const auto by_me = [&](std::int64_t high) {
            return make_choice(is_one(0), by_right(high + 2), by_right(high));
        };
        return make_choice(is_one(-1), by_me(4), by_me(0));
    }

    // The figure of each cell, in the order of the cells: [ana, rui], or fan for fan[1], fan[2],
    // ...
    std::vector<lang::Path> figures() {
        std::vector<lang::Path> out;
        if (!figures_) {
            return out;
        }
        if (figures_.kind == ExprKind::kList) {
            for (const lang::Argument& a : figures_.args) {
                if (a.value.kind != ExprKind::kPath) {
                    teller_.error("syntax", a.value.span, "this is no figure",
                                  "write the name of a member of the cast");
                    return {};
                }
                out.push_back(a.value.path);
            }
        } else if (figures_.kind == ExprKind::kPath) {
            for (std::int64_t row = 0; row < grid_.rows; ++row) {
                for (std::int64_t column = 0; column < grid_.columns; ++column) {
                    lang::Path path = figures_.path;
                    path.steps.back() =
                        grid_.name(path.steps.back().text, column, row, figures_.span);
                    out.push_back(std::move(path));
                }
            }
        }
        if (out.size() != cells_.size()) {
            teller_.error("wrong-count", figures_.span,
                          "there are " + std::to_string(cells_.size()) + " cells and " +
                              std::to_string(out.size()) + " figures",
                          "name a figure for each cell, in order");
            return {};
        }
        return out;
    }

    void warn_of_never_entered() {
        std::vector<std::vector<std::size_t>> next(states_.size());
        std::vector<std::size_t> begins{0};
        for (const Rule& r : rules_) {
            next[r.from].push_back(r.to);
        }
        for (std::size_t i = 0; i < states_.size(); ++i) {
            if (states_[i].there) {
                begins.push_back(i);
            }
        }
        const std::vector<bool> entered = reachable(next, begins);
        for (std::size_t i = 0; i < states_.size() && !wolfram_; ++i) {
            const State& s = states_[i];
            if (!entered[i]) {
                teller_.warn("never-entered", s.span, "no cell is ever " + s.name.text,
                             "add a line: ... -> " + s.name.text + ", or remove it");
            }
        }
    }

    void make() {
        warn_of_never_entered();
        const auto is_said = [](const lang::Property& p) { return has_arrow(p); };
        if (!wolfram_ &&
            std::none_of(block_.properties.begin(), block_.properties.end(), is_said)) {
            teller_.error("no-rule", block_.name.span, "no line says how cells change",
                          "write " + std::string(kRuleForm));
            return;
        }
        const std::size_t each = wolfram_ ? 15 : nodes(next(grid_.columns / 2, grid_.rows / 2));
        if (each > kMostNodes / cells_.size()) {
            teller_.error("net-too-large", block_.name.span,
                          "the rules of all cells together have more than " +
                              std::to_string(kMostNodes) + " terms",
                          "use fewer cells, or a smaller neighbourhood");
            return;
        }
        const lang::Span span = shape_span_;
        lang::Enumeration states;
        states.name = make_name("State", block_.name.span);
        states.span = block_.name.span;
        for (const State& s : states_) {
            states.values.push_back(s.name);
        }
        body_.enumerations.push_back(std::move(states));
        lang::Transition step = make_clock(body_, period_);
        for (std::int64_t row = 0; row < grid_.rows; ++row) {
            for (std::int64_t column = 0; column < grid_.columns; ++column) {
                lang::Data cell;
                cell.name = grid_.name("cell", column, row, span);
                cell.is_public = true;
                cell.type = make_reference("State", span);
                cell.initial = state_value(at(column, row), span);
                cell.span = span;
                body_.data.push_back(std::move(cell));
                step.assignments.push_back(make_assignment(
                    make_path({grid_.name("cell", column, row, span)}, span), next(column, row)));
            }
        }
        if (ending_) {
            step.outputs.push_back(
                make_arc(lang::ArcKind::kGive, make_path(kGenerations, ending_.span)));
        }
        body_.transitions.push_back(std::move(step));
        const std::vector<lang::Path> who = figures();
        for (std::size_t i = 0; i < who.size(); ++i) {
            figure(static_cast<std::int64_t>(i), who[i]);
        }
        if (who.empty() && !figures_) {
            for (const State& s : states_) {
                if (s.does) {
                    teller_.error("no-figures", s.does.span, "the cells are no figures",
                                  "write figures [ana, rui, ...], one for each cell");
                    return;
                }
            }
        }
    }

    std::size_t at(std::int64_t column, std::int64_t row) const {
        return cells_[static_cast<std::size_t>(row * grid_.columns + column)];
    }

    static void give_name(Expr& e, const lang::Path& who) {
        if (!e.path.empty() && e.path.steps[0].text == "me" && e.path.steps[0].index.empty()) {
            lang::Path path = who;
            path.span = e.path.span;
            path.steps.insert(path.steps.end(), e.path.steps.begin() + 1, e.path.steps.end());
            e.path = std::move(path);
        }
        for (lang::Argument& a : e.args) {
            give_name(a.value, who);
        }
    }

    // A place for each state that does not continue another, and a transition for each change that
    // a line allows.
    void figure(std::int64_t number, const lang::Path& who) {
        const std::int64_t column = number % grid_.columns, row = number / grid_.columns;
        const auto named = [&](const std::string& text, lang::Span span) {
            return grid_.name(text, column, row, span);
        };
        for (std::size_t s = 0; s < states_.size(); ++s) {
            const State& state = states_[s];
            if (state.place != s) {
                continue;
            }
            lang::Place place = make_place(named(state.name.text, state.span));
            place.is_public = true;
            place.caption = captions_[s];
            place.does = state.does;
            place.takes = state.takes;
            give_name(place.does, who);
            if (states_[at(column, row)].place == s) {
                give_token(place);
            }
            body_.places.push_back(std::move(place));
        }
        std::map<std::pair<std::size_t, std::size_t>, lang::Span> changes;
        for (const Rule& r : rules_) {
            changes.emplace(std::pair(r.from, r.to), r.span);
        }
        std::set<std::pair<std::size_t, std::size_t>> made;  // from a place, to a state
        if (wolfram_) {
            changes = {{{0, 1}, wolfram_span_}, {{1, 0}, wolfram_span_}};
        }
        for (const auto& [change, span] : changes) {
            const std::size_t from = states_[change.first].place;
            const std::size_t to = states_[change.second].place;
            if (from == to || !made.insert({from, change.second}).second) {
                continue;  // the figure goes on; or another line does the same
            }
            const std::string& before = states_[change.first].name.text;
            const std::string& after = states_[change.second].name.text;
            lang::Transition t =
                make_transition(named(before + "_to_" + after, span), {},
                                {make_path({named(states_[to].name.text, span)}, span)});
            t.inputs.push_back(make_arc(lang::ArcKind::kTakeNow,
                                        make_path({named(states_[from].name.text, span)}, span)));
            t.guard = make_binary(Op::kEqual, grid_.state(column, row, {}, span),
                                  state_value(change.second, span));
            t.priority = make_number(Rational{kFollows + number % kOrders}, span);
            t.is_public = true;
            t.span = span;
            body_.transitions.push_back(std::move(t));
        }
    }

    const lang::Block& block_;
    Teller teller_;
    lang::Body& body_;
    CellGrid grid_;
    int errors_ = 0;
    Expr period_, figures_;
    Ending ending_;
    lang::Path outside_;
    lang::Span shape_span_{}, wolfram_span_{};
    std::optional<std::int64_t> wolfram_;
    std::vector<State> states_;
    std::vector<lang::Caption> captions_;  // by state
    std::vector<Rule> rules_;
    std::vector<std::size_t> cells_;  // the state of each at the start, row by row
};

}  // namespace

void lower_cells(const lang::Block& block, const lang::File& file, Lowered& out) {
    Cells(block, file, out).lower();
}

}  // namespace puppetri::notation
