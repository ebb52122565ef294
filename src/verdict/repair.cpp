// SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "puppetri/lang/edit.h"
#include "puppetri/lang/parse.h"
#include "puppetri/net/tables.h"
#include "puppetri/proof/supervisor.h"
#include "puppetri/verdict/explain.h"
#include "puppetri/verdict/obligation.h"
#include "puppetri/verdict/prove.h"
#include "script_player.h"

namespace puppetri::verdict {
namespace {

using net::Formula;
using net::FormulaOp;

// The scene's own file changed, everything else as it is.
class Overlay final : public scene::FileSource {
 public:
    Overlay(scene::FileSource& below, std::string path, std::string text)
        : below_(below), path_(std::move(path)), text_(std::move(text)) {}
    Result<std::string, scene::FileProblem> read(const std::string& path) override {
        return path == path_ ? Result<std::string, scene::FileProblem>(text_) : below_.read(path);
    }
    std::string resolve(const std::string& importer, const std::string& written) override {
        return below_.resolve(importer, written);
    }

 private:
    scene::FileSource& below_;
    std::string path_, text_;
};

// Lines that go and come, by the longest common subsequence.
std::string diff_of(const std::string& before, const std::string& after) {
    const auto lines_of = [](const std::string& text) {
        std::vector<std::string> lines;
        std::size_t begin = 0;
        while (begin < text.size()) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            lines.push_back(text.substr(begin, end - begin));
            begin = end + 1;
        }
        return lines;
    };
    const std::vector<std::string> a = lines_of(before), b = lines_of(after);
    std::size_t head = 0;
    while (head < a.size() && head < b.size() && a[head] == b[head]) {
        ++head;
    }
    std::size_t tail = 0;
    while (tail + head < a.size() && tail + head < b.size() &&
           a[a.size() - 1 - tail] == b[b.size() - 1 - tail]) {
        ++tail;
    }
    const std::size_t n = a.size() - head - tail, m = b.size() - head - tail;
    if (n * m > 4'000'000) {
        return {};
    }
    std::vector<std::vector<std::uint32_t>> common(n + 1, std::vector<std::uint32_t>(m + 1, 0));
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = m; k-- > 0;) {
            common[i][k] = a[head + i] == b[head + k]
                               ? common[i + 1][k + 1] + 1
                               : std::max(common[i + 1][k], common[i][k + 1]);
        }
    }
    std::string out;
    std::size_t i = 0, k = 0;
    while (i < n || k < m) {
        if (i < n && k < m && a[head + i] == b[head + k]) {
            ++i;
            ++k;
        } else if (i < n && (k == m || common[i + 1][k] >= common[i][k + 1])) {
            out += "- " + a[head + i++] + "\n";
        } else {
            out += "+ " + b[head + k++] + "\n";
        }
    }
    return out;
}

RepairAnswer no(std::string reason) { return {.repair = {}, .reason = std::move(reason)}; }

// What the rule bounds: the sum of its places, at most so many.
struct Bound {
    proof::LinearSum sum;
    std::int64_t limit = 0;
};
std::optional<Bound> bound_of(const net::Rule& rule) {
    Bound b;
    std::set<std::uint32_t> places;
    for (const Formula& f : rule.operands) {
        for (const Formula::Node& n : f.nodes) {
            const bool conjunction = rule.kind == net::RuleKind::kNever && n.op == FormulaOp::kAnd;
            if (n.op == FormulaOp::kMarked && n.count == 1) {
                places.insert(n.index);
            } else if (!conjunction) {
                return std::nullopt;
            }
        }
    }
    for (const std::uint32_t p : places) {
        b.sum.terms.push_back({p, 1});
    }
    switch (rule.kind) {
        case net::RuleKind::kMutex:
            b.limit = 1;
            break;
        case net::RuleKind::kNever:
            b.limit = static_cast<std::int64_t>(places.size()) - 1;
            break;
        case net::RuleKind::kBounded:
            if (places.size() != 1 || rule.count == kNoCount) {
                return std::nullopt;
            }
            b.limit = rule.count;
            break;
        default:
            return std::nullopt;
    }
    return places.empty() ? std::nullopt : std::optional(b);
}

std::string weighted(const std::string& name, std::uint32_t weight) {
    return weight == 1 ? name : std::to_string(weight) + "*" + name;
}

// The place and its arcs as edits of the file.
class Editor {
 public:
    Editor(const lang::File& file, const net::Net& net, std::string name)
        : file_(file), net_(net), name_(std::move(name)) {}

    std::string trouble;

    std::vector<lang::Edit> edits(const proof::MonitorPlace& place, const std::string& caption) {
        std::vector<lang::Edit> out;
        if (file_.body.places.empty()) {
            trouble = "the scene's places stand in nets";
            return out;
        }
        std::string statement = "place " + name_ + " \"" + caption + "\"";
        if (place.tokens > 0) {
            statement += "  tokens " + std::to_string(place.tokens);
        }
        out.push_back(lang::insert_after(file_, file_.body.places.back().span, statement));
        for (const proof::MonitorPlace::Arc& arc : place.takes) {
            add_arc(arc, true, out);
        }
        for (const proof::MonitorPlace::Arc& arc : place.gives) {
            add_arc(arc, false, out);
        }
        return out;
    }

 private:
    void add_arc(const proof::MonitorPlace::Arc& arc, bool takes, std::vector<lang::Edit>& out) {
        const std::string path(net_.transition(net::TransitionIndex{arc.transition}).path);
        const auto found =
            std::find_if(file_.body.transitions.begin(), file_.body.transitions.end(),
                         [&](const lang::Transition& t) { return t.name.text == path; });
        if (found == file_.body.transitions.end()) {
            trouble = "it would change " + path +
                      ", which does not stand in the scene's own file "
                      "outside of nets";
            return;
        }
        const std::vector<lang::Arc>& arcs = takes ? found->inputs : found->outputs;
        const std::string text = weighted(name_, arc.weight);
        if (!arcs.empty()) {
            const std::uint32_t at = arcs.back().span.end;
            out.push_back({{at, at, found->span.file}, " + " + text});
            return;
        }
        const std::size_t arrow = file_.text.find("->", found->span.begin);
        if (arrow == std::string::npos || arrow >= found->span.end) {
            trouble = path + " cannot be changed";
            return;
        }
        const auto at = static_cast<std::uint32_t>(takes ? arrow : arrow + 2);
        out.push_back({{at, at, found->span.file}, takes ? text + " " : " " + text});
    }

    const lang::File& file_;
    const net::Net& net_;
    const std::string name_;
};

std::string free_name(const net::Net& net, const std::string& rule) {
    std::string name = "keeps_" + rule;
    for (char& c : name) {
        const bool good = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '_' ||
                          static_cast<unsigned char>(c) >= 0x80;
        c = good ? c : '_';
    }
    std::string out = name;
    for (int i = 2; net.find_place(out).valid() || net.find_transition(out).valid(); ++i) {
        out = name + std::to_string(i);
    }
    return out;
}

proof::Marking marking_after(const scene::Scene& scene, const Witness& witness) {
    ScriptPlayer player(scene, witness);
    while (player.step()) {
    }
    proof::Marking m(scene.net.place_count());
    for (std::uint32_t p = 0; p < scene.net.place_count(); ++p) {
        m[p] = player.player().tokens(net::PlaceIndex{p});
    }
    return m;
}

}  // namespace

RepairAnswer repair(scene::FileSource& files, const scene::Scene& scene,
                    const std::vector<Verdict>& verdicts, const std::string& rule,
                    const proof::Budget& budget) {
    const auto verdict = std::find_if(verdicts.begin(), verdicts.end(),
                                      [&](const Verdict& v) { return v.rule == rule; });
    if (verdict == verdicts.end() || verdict->answer != Answer::kRefuted || !verdict->witness) {
        return no("only what is refuted by a run can be repaired");
    }
    const std::vector<net::Rule> rules = rules_of(scene);
    const auto r = std::find_if(rules.begin(), rules.end(),
                                [&](const net::Rule& x) { return x.path == rule; });
    if (r == rules.end()) {
        return no("there is no rule " + rule);
    }
    const proof::Plain plain = proof::plain(scene.net);
    if (plain.unsound) {
        return no("the net does more than its arcs say: " + plain.net.left_out.front());
    }
    proof::SupervisorAnswer answer;
    Repair out;
    std::string caption;
    if (const auto bound = bound_of(*r)) {
        answer = proof::supervise(plain.net, bound->sum, bound->limit);
        out.source = "Moody and Antsaklis 1998: a place that counts what is left of the bound";
        caption = "keeps " + rule;
    } else if (r->kind == net::RuleKind::kDeadlockFree ||
               r->kind == net::RuleKind::kNobodyFreezes || r->kind == net::RuleKind::kLive) {
        const std::vector<std::uint32_t> siphon =
            empty_siphon(plain.net, marking_after(scene, *verdict->witness));
        if (siphon.empty()) {
            return no("no set of places has run empty for ever: weights or tests are to blame");
        }
        answer = proof::monitor_siphon(plain.net, siphon);
        out.source = "Ezpeleta, Colom and Martinez 1995: a siphon that never runs empty";
        caption = "keeps one token among what they wait for";
    } else {
        return no("theory has a supervisor for mutex, never, bounded, deadlocks and freezing");
    }
    if (!answer.possible) {
        return no(answer.reason);
    }
    const auto text = files.read(scene.path);
    if (!text) {
        return no(text.error().message);
    }
    const lang::Parsed parsed = lang::parse(*text, scene.path);
    const std::string name = free_name(scene.net, rule);
    Editor editor(parsed.file, scene.net, name);
    const std::vector<lang::Edit> edits = editor.edits(answer.place, caption);
    if (!editor.trouble.empty()) {
        return no(editor.trouble);
    }
    auto changed = lang::apply(parsed.file, edits);
    if (!changed) {
        return no("the edits do not fit: " + changed.error().front().message);
    }
    Overlay overlay(files, scene.path, *changed);
    const auto repaired = scene::load(overlay, scene.path);
    if (!repaired) {
        return no("the changed scene has an error: " + repaired.error().front().message);
    }
    out.proved = prove(*repaired, {.budget = budget});
    for (const Verdict& now : out.proved) {
        if (now.rule == rule && now.answer != Answer::kProved) {
            return no("with one more place the rule would be " + name_of(now) + " again");
        }
        const auto before = std::find_if(verdicts.begin(), verdicts.end(),
                                         [&](const Verdict& v) { return v.rule == now.rule; });
        if (before != verdicts.end() && before->answer == Answer::kProved &&
            now.answer != Answer::kProved) {
            return no("with one more place " + now.rule + " would be " + name_of(now));
        }
    }
    out.idea = "one more place, " + name + " (" + std::to_string(answer.place.tokens) +
               (answer.place.tokens == 1 ? " token" : " tokens") + "): " + caption;
    out.diff = diff_of(*text, *changed);
    out.text = std::move(*changed);
    return {.repair = std::move(out), .reason = {}};
}

}  // namespace puppetri::verdict
