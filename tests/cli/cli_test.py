#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The command line from outside: exit codes, what goes to stdout and to stderr, files whole or absent, sessions.

Usage: cli_test.py PROGRAM ROOT
"""
import csv
import io
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
ROOT = pathlib.Path(sys.argv[2])
EXAMPLES = ROOT / "examples"
FRAME = 705_600_000 // 24


def run(*arguments, stdin="", cwd=None):
    return subprocess.run([PROGRAM, *map(str, arguments)], input=stdin, capture_output=True, text=True, cwd=cwd,
                          timeout=120)


class Cli(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def scene(self, text, name="scene.pup"):
        path = self.path / name
        path.write_text(text)
        return path


class Usage(Cli):
    def test_help_and_version_are_fine(self):
        for arguments in (["--help"], ["--version"], ["run", "--help"], ["check", "--help"], ["fmt", "--help"],
                          ["new", "--help"], ["draw", "--help"]):
            done = run(*arguments)
            self.assertEqual(done.returncode, 0, arguments)
            self.assertTrue(done.stdout)
        self.assertIn("Examples:", run("run", "--help").stdout)

    def test_bad_usage_exits_2(self):
        for arguments in ([], ["dance"], ["run"], ["run", "a", "b"], ["check", "--jsn", "x"],
                          ["run", EXAMPLES / "01_toss/toss.pup", "--seed", "x"],
                          ["run", EXAMPLES / "01_toss/toss.pup", "--for", "4"],
                          ["run", EXAMPLES / "01_toss/toss.pup", "--for", "4kg"],
                          ["draw", EXAMPLES / "01_toss/toss.pup", "--as", "svg"]):
            done = run(*arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertEqual(done.stdout, "")
            self.assertTrue(done.stderr)

    def test_a_missing_or_bad_file_exits_2(self):
        for command in ("check", "run", "fmt", "draw"):
            done = run(command, self.path / "missing.pup")
            self.assertEqual(done.returncode, 2)
            self.assertIn("missing.pup", done.stderr)
        bad = self.scene("scene \"x\"\nplace P does nobody.step(left)\n")
        for command in ("check", "run", "draw"):
            self.assertEqual(run(command, bad).returncode, 2)

    def test_no_colours_where_there_is_no_terminal(self):
        bad = self.scene("place P takes 3 m\n")
        self.assertNotIn("\033", run("check", bad).stderr)
        self.assertNotIn("\033", run("run", EXAMPLES / "01_toss/toss.pup").stderr)


class Check(Cli):
    def test_a_defect_has_its_place_a_caret_and_a_remedy(self):
        bad = self.scene("cast { ana: mannequin }\nplace P does ana.thrw()\n")
        done = run("check", bad)
        self.assertEqual(done.returncode, 2)
        self.assertIn(f"{bad}:2:18: error:", done.stderr)
        self.assertIn("place P does ana.thrw()\n", done.stderr)
        self.assertIn("^~~~", done.stderr)
        self.assertIn("throw", done.stderr)
        self.assertIn("1 error", done.stderr)

    def test_json_goes_to_stdout_alone(self):
        bad = self.scene("place P takes 3 m\nt: P -> \"x\n")
        done = run("check", bad, "--json")
        report = json.loads(done.stdout)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(report["errors"], len(report["diagnostics"]))
        for d in report["diagnostics"]:
            self.assertEqual(d["file"], str(bad))
            self.assertTrue(d["code"] and d["message"] and d["remedy"] and d["line"] >= 1)
        good = run("check", EXAMPLES / "03_ball/ball.pup", "--json")
        self.assertEqual(good.returncode, 0)
        self.assertEqual(json.loads(good.stdout)["diagnostics"], [])

    def test_every_example_is_fine_and_in_canonical_form(self):
        for path in sorted(EXAMPLES.glob("*/*.pup")):
            self.assertEqual(run("fmt", "--check", path).returncode, 0, path)
            # Characters that the project does not have
            files = {name: ROOT.parent / "shared" / "motion" / name
                     for name in re.findall(r'file "([^"]+)"', path.read_text())}
            if not all(file.exists() for file in files.values()):
                print(f"skipped: {path.name} needs {', '.join(files)}", file=sys.stderr)
                continue
            given = [text for name, file in files.items() for text in ("--file", f"{name}={file}")]
            self.assertEqual(run("check", path, *given).returncode, 0, path)
            if files:
                missing = run("check", path)
                self.assertEqual(missing.returncode, 2)
                self.assertIn("--file", missing.stderr)


class Fmt(Cli):
    UGLY = "# kept\nplace   P   takes 1 s   # too\nt :P->P\n"

    def test_prints_checks_and_writes(self):
        path = self.scene(self.UGLY)
        printed = run("fmt", path)
        self.assertEqual(printed.returncode, 0)
        self.assertIn("# kept", printed.stdout)
        self.assertEqual(path.read_text(), self.UGLY)
        self.assertEqual(run("fmt", "--check", path).returncode, 1)
        self.assertEqual(run("fmt", "-", stdin=self.UGLY).stdout, printed.stdout)
        self.assertEqual(run("fmt", "--write", path).returncode, 0)
        self.assertEqual(path.read_text(), printed.stdout)
        self.assertEqual(run("fmt", "--check", path).returncode, 0)

    def test_a_file_with_a_defect_is_left_alone(self):
        path = self.scene("place P takes\n")
        self.assertEqual(run("fmt", "--write", path).returncode, 2)
        self.assertEqual(path.read_text(), "place P takes\n")


class Run(Cli):
    BALL = EXAMPLES / "03_ball/ball.pup"
    WALK = EXAMPLES / "02_walk/figure.pup"

    def test_the_log_of_the_walk_is_the_papers(self):
        log = self.path / "log.csv"
        self.assertEqual(run("run", self.WALK, "--log", log).returncode, 0)
        rows = list(csv.DictReader(io.StringIO(log.read_text())))
        self.assertEqual(list(rows[0]), ["tick", "seconds", "transition"])
        self.assertEqual([(int(r["tick"]) / FRAME, r["transition"]) for r in rows if r["transition"] != "t5"],
                         [(0, "t1"), (10, "t2"), (30, "t3"), (50, "t8"), (60, "t10")])
        for r in rows:
            self.assertEqual(float(r["seconds"]), int(r["tick"]) / 705_600_000)

    def test_the_score_has_its_columns(self):
        done = run("run", self.BALL, "--score", "-")
        rows = list(csv.DictReader(io.StringIO(done.stdout)))
        self.assertEqual(list(rows[0]), "start_tick,end_tick,left_tick,start_seconds,end_seconds,place,actor,limbs,"
                                        "movement,prop,instance".split(","))
        step = next(r for r in rows if r["place"] == "a.with_ball.P4")
        self.assertEqual((step["actor"], step["movement"], step["instance"]), ("ana", "step", "a.with_ball"))
        self.assertEqual(int(step["end_tick"]) - int(step["start_tick"]), 20 * FRAME)
        fly = next(r for r in rows if r["movement"] == "fly")
        self.assertEqual((fly["actor"], fly["prop"]), ("", "ball"))

    def test_the_hash_is_that_of_seed_and_scene(self):
        hashes = [run("run", self.BALL, "--hash").stdout for _ in range(2)]
        self.assertEqual(hashes[0], hashes[1])
        self.assertRegex(hashes[0], r"^[0-9a-f]{16}\n$")
        self.assertEqual(json.loads(run("run", self.BALL, "--json").stdout)["log_hash"], hashes[0].strip())

    def test_a_run_ends_after_time_frames_or_firings(self):
        for limit in ("2.5s", "60f", "60 frames", "2500ms"):
            report = json.loads(run("run", self.BALL, "--for", limit, "--json").stdout)
            self.assertEqual((report["ticks"], report["frames"], report["stop"]), (60 * FRAME, 60, "limit"), limit)
        for limit in ("17x", "17 firings"):
            self.assertEqual(json.loads(run("run", self.BALL, "--for", limit, "--json").stdout)["firings"], 17)

    def test_events_come_from_a_file_or_from_stdin_and_sessions_replay(self):
        scene = self.scene("scene \"x\"\nuntil 6 s\nevent go\nplace idle tokens 1\nplace busy takes 0.5 .. 1.5 s\n"
                           "start: idle -> busy on go\nfinish: busy -> idle\n")
        lines = "1 s go\n2.75 s go\n5 s go\n"
        (self.path / "go.txt").write_text(lines)
        from_file = run("run", scene, "--events", self.path / "go.txt", "--hash")
        session = self.path / "session.txt"
        live = run("run", scene, "--events", "-", "--record", session, "--hash", stdin=lines)
        self.assertEqual(from_file.returncode, 0)
        self.assertEqual(live.stdout, from_file.stdout)
        self.assertEqual(run("run", scene, "--events", session, "--hash").stdout, live.stdout)
        now = run("run", scene, "--events", "-", "--record", session, "--hash", "--seed", "5", stdin="now go\n3 s go\n")
        self.assertEqual(run("run", scene, "--events", session, "--hash").stdout, now.stdout)  # the seed is in it
        self.assertEqual(json.loads(run("run", scene, "--events", session, "--json").stdout)["firings"], 4)
        (self.path / "bad.txt").write_text("1 s og\n")
        bad = run("run", scene, "--events", self.path / "bad.txt")
        self.assertEqual(bad.returncode, 2)
        self.assertIn("bad.txt:1:5", bad.stderr)

    def test_courses_are_baked_once_and_read_from_then_on(self):
        scene = self.scene('language 1\nscene "falls"\nuntil 3 s\nequations decay {\n  x starts at 1\n'
                           '  x.rate = -900 Hz*(x - cos(t/1 s))\n  event low when x falls through 0.5\n'
                           '  solver stiff by sundials\n  baked "x.courses"\n}\nplace up  tokens 1\nplace down\n'
                           'falls: up -> down on d.low\nuse decay() as d\n')
        done = run("run", scene, "--hash")
        self.assertEqual(done.returncode, 2)
        self.assertIn("[not-baked]", done.stderr)
        done = run("run", scene, "--bake", "--hash")
        if "[no-sundials]" in done.stderr:
            self.assertEqual(done.returncode, 2)
            self.skipTest("this build has no SUNDIALS")
        self.assertEqual(done.returncode, 0, done.stderr)
        baked = done.stdout
        done = run("run", scene, "--hash")
        self.assertEqual((done.returncode, done.stdout), (0, baked))
        self.assertNotIn("warning", done.stderr)
        for damage in (lambda b: b[:-20], lambda b: b[:40] + b"x" + b[41:]):
            whole = (self.path / "x.courses").read_bytes()
            (self.path / "x.courses").write_bytes(damage(whole))
            done = run("run", scene)
            self.assertEqual(done.returncode, 2)
            self.assertIn("[bad-course]", done.stderr)
            (self.path / "x.courses").write_bytes(whole)
        done = run("run", EXAMPLES / "01_toss/toss.pup", "--bake")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--bake", done.stderr)

    def test_notes_of_one_kind_are_told_a_few_times(self):
        scene = self.scene("scene \"x\"\nuntil 60 s\nevent go every 1 s\nplace P takes 7 s tokens 1\nt: P -> P on go\n")
        done = run("run", scene)
        self.assertEqual(done.stderr.count("nothing used it"), 5)
        self.assertRegex(done.stderr, r"and \d+ more of this kind \[lost-event\]")
        self.assertGreater(len(json.loads(run("run", scene, "--json").stdout)["notes"]), 40)

    def test_a_fault_of_the_run_exits_1_with_its_reason(self):
        scene = self.scene("scene \"x\"\ndata n: 0 .. 2 = 0\nplace P tokens 1 takes 1 s\nt: P -> P set n := n + 1\n"
                           "until 9 s\n")
        done = run("run", scene)
        self.assertEqual(done.returncode, 1)
        self.assertIn("n", done.stderr)
        self.assertEqual(json.loads(run("run", scene, "--json").stdout)["stop"], "fault")

    def test_what_cannot_be_written_exits_1_and_leaves_nothing(self):
        done = run("run", self.WALK, "--log", self.path / "missing" / "log.csv")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(os.listdir(self.path), [])

    def test_ctrl_c_ends_with_what_is_known(self):
        scene = self.scene("scene \"x\"\nuntil 1000000 h\nplace P takes 1 ms tokens 1\nt: P -> P\n")
        log = self.path / "log.csv"
        process = subprocess.Popen([PROGRAM, "run", scene, "--log", log, "--json"], stdout=subprocess.PIPE, text=True)
        for _ in range(600):  # the unfinished log shows that it runs
            if len(os.listdir(self.path)) > 1:
                break
            time.sleep(0.05)
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=30)
        report = json.loads(out)
        self.assertEqual((process.returncode, report["stop"]), (1, "interrupted"))
        with log.open() as lines:
            self.assertEqual(sum(1 for _ in lines) - 1, report["firings"])
        self.assertEqual(sorted(os.listdir(self.path)), ["log.csv", "scene.pup"])


class Explore(Cli):
    # A token walks on a ring of 50 places, twice: 50 * 50 markings, an edge per ring in each.
    RINGS = "net rings\n" + "".join(
        f"pl {r}{i} ({1 if i == 0 else 0})\ntr t{r}{i} {r}{i} -> {r}{(i + 1) % 50}\n" for r in "ab" for i in range(50))

    def test_counts_go_to_stdout_as_json(self):
        net = self.scene(self.RINGS, "rings.net")
        for threads in ("1", "2"):
            done = run("explore", net, "--json", "--threads", threads)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            report = json.loads(done.stdout)
            self.assertEqual([report[k] for k in ("states", "edges", "max_tokens_in_place", "max_tokens_per_marking")],
                             [2500, 5000, 1, 2])
            self.assertGreater(report["bytes_per_state"], 0)
            self.assertGreaterEqual(report["seconds"], 0)

    def test_an_unbounded_net_is_unknown_and_its_place_is_named(self):
        net = self.scene("net n\npl a (1)\ntr t a -> a b\ntr u b -> c\n", "n.net")
        done = run("explore", net, "--json", "--time", "300ms")
        self.assertEqual(done.returncode, 3)
        report = json.loads(done.stdout)
        self.assertFalse(report["complete"])
        self.assertIn(report["unbounded_place"], ("b", "c"))
        self.assertIn("place " + report["unbounded_place"], done.stderr)

    def test_ctrl_c_and_small_budgets_end_with_what_is_known(self):
        text = "net n\npl a (1)\n" + "".join(f"tr t{i} a -> a b{i}\n" for i in range(6))
        net = self.scene(text, "n.net")
        done = run("explore", net, "--json", "--memory", "20M")
        self.assertEqual(done.returncode, 3)
        self.assertGreater(json.loads(done.stdout)["states"], 10000)
        process = subprocess.Popen([PROGRAM, "explore", net, "--json"], stdout=subprocess.PIPE,
                                   stderr=subprocess.DEVNULL, text=True)
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=30)
        self.assertEqual((process.returncode, json.loads(out)["ended"]), (3, "cancelled"))
        self.assertEqual(run("explore", net, "--time", "soon").returncode, 2)


class Query(Cli):
    # One token goes round a b c or, once, to the end.
    NET = "net n\npl a (1)\ntr t a -> b\ntr u b -> c\ntr v c -> a\ntr w c -> end\n"

    def queries(self, *formulas):
        text = "".join(f"<property><id>q-{i}</id><description/><formula>{f}</formula></property>"
                       for i, f in enumerate(formulas))
        return self.scene(f'<property-set xmlns="http://mcc.lip6.fr/">{text}</property-set>', "q.xml")

    def test_answers_are_lines_in_the_contests_form(self):
        net = self.scene(self.NET, "n.net")
        ends = "<integer-le><integer-constant>1</integer-constant><tokens-count><place>end</place></tokens-count></integer-le>"
        xml = self.queries(
            f"<exists-path><finally>{ends}</finally></exists-path>",
            f"<all-paths><finally>{ends}</finally></all-paths>",
            f"<all-paths><globally><exists-path><finally>{ends}</finally></exists-path></globally></all-paths>",
            f"<all-paths><finally><globally>{ends}</globally></finally></all-paths>",
            "<place-bound><place>a</place><place>b</place></place-bound>")
        done = run("query", net, "--queries", xml)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual([line.split()[:3] for line in done.stdout.splitlines()],
                         [["FORMULA", "q-0", "TRUE"], ["FORMULA", "q-1", "FALSE"], ["FORMULA", "q-2", "TRUE"],
                          ["FORMULA", "q-3", "FALSE"], ["FORMULA", "q-4", "1"]])
        self.assertTrue(all(" TECHNIQUES " in line for line in done.stdout.splitlines()))
        answers = json.loads(run("query", net, "--queries", xml, "--json", "--threads", "2").stdout)["answers"]
        self.assertEqual([a["value"] for a in answers], [True, False, True, False, 1])

    def test_examinations_need_no_file(self):
        net = self.scene(self.NET, "n.net")
        for name, answer in (("ReachabilityDeadlock", "TRUE"), ("QuasiLiveness", "TRUE"), ("Liveness", "FALSE"),
                             ("OneSafe", "TRUE"), ("StableMarking", "FALSE")):
            done = run("query", net, "--examination", name)
            self.assertEqual(done.stdout.split()[:3], ["FORMULA", name, answer])
        done = run("query", net, "--examination", "StateSpace")
        self.assertEqual([line.split()[1:3] for line in done.stdout.splitlines()],
                         [["STATES", "4"], ["TRANSITIONS", "4"], ["MAX_TOKEN_PER_MARKING", "1"],
                          ["MAX_TOKEN_IN_PLACE", "1"]])

    def test_what_cannot_be_answered_is_missing_and_bad_usage_is_told(self):
        growing = self.scene("net n\npl a (1)\ntr t a -> a b\n", "g.net")
        done = run("query", growing, "--examination", "StateSpace", "--time", "300ms")
        self.assertEqual((done.returncode, done.stdout), (3, "CANNOT_COMPUTE\n" * 4))
        net = self.scene(self.NET, "n.net")
        self.assertEqual(run("query", net).returncode, 2)
        self.assertEqual(run("query", net, "--examination", "Everything").returncode, 2)
        self.assertEqual(run("query", net, "--queries", self.path / "none.xml").returncode, 2)
        xml = self.queries("<place-bound><place>nowhere</place></place-bound>")
        self.assertEqual(run("query", net, "--queries", xml).returncode, 2)


class New(Cli):
    def test_each_template_is_a_scene_that_runs(self):
        for template in ("toss", "walk", "ball"):
            name = f"my_{template}"
            self.assertEqual(run("new", name, "--template", template, cwd=self.path).returncode, 0)
            self.assertEqual(run("run", self.path / f"{name}.pup", "--for", "2s").returncode, 0, template)

    def test_nothing_is_overwritten(self):
        path = self.scene("# mine\n", "duet.pup")
        self.assertEqual(run("new", "duet", cwd=self.path).returncode, 1)
        self.assertEqual(path.read_text(), "# mine\n")
        self.assertEqual(run("new", "a b", cwd=self.path).returncode, 2)
        self.assertEqual(run("new", "x", "--template", "opera", cwd=self.path).returncode, 2)
        self.assertEqual(os.listdir(self.path), ["duet.pup"])


class Draw(Cli):
    def test_figure_2_in_mathematical_notation(self):
        done = run("draw", EXAMPLES / "04_three_arcs/three_arcs.pup", "--as", "math")
        self.assertEqual(done.returncode, 0)
        self.assertEqual(done.stdout, (EXAMPLES / "04_three_arcs/expected.txt").read_text())


class Convert(Cli):
    CORPUS = ROOT / "tests/corpus/nets"

    def test_endings_decide_and_to_overrides_them(self):
        net = self.path / "a.net"
        self.assertEqual(run("convert", self.CORPUS / "untimed.net", self.path / "a.pnml").returncode, 0)
        self.assertEqual(run("convert", self.path / "a.pnml", net).returncode, 0)
        self.assertIn("tr source -> p", net.read_text())
        done = run("convert", net, "-", "--to", "dot")
        self.assertEqual((done.returncode, done.stdout[:7]), (0, "digraph"))
        self.assertEqual(run("convert", net, self.path / "a.doc").returncode, 2)
        self.assertEqual(run("convert", net, "-", "--to", "word").returncode, 2)

    def test_what_a_format_cannot_say_is_refused_by_name_or_dropped_and_told(self):
        scene, out = EXAMPLES / "03_ball/ball.pup", self.path / "ball.pnml"
        done = run("convert", scene, out)
        self.assertEqual(done.returncode, 1)
        self.assertIn("PNML has no movements (place a.to_throw) [not-in-format]", done.stderr)
        self.assertFalse(out.exists())
        done = run("convert", scene, out, "--lossy")
        self.assertEqual(done.returncode, 0)
        self.assertIn("movements were dropped", done.stderr)
        self.assertIn('<place id="a.with_ball.P4">', out.read_text())

    def test_a_stochastic_net_becomes_a_scene_that_runs(self):
        scene = self.path / "readers.pup"
        self.assertEqual(run("convert", self.CORPUS / "readers.xml", scene).returncode, 0)
        done = run("run", scene, "--for", "2s")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_all_defects_of_a_net_are_told_with_their_lines(self):
        net = self.path / "bad.net"
        net.write_text("tr t p!2 -> q\npl p (x)\n")
        done = run("convert", net, "-", "--to", "pnml")
        self.assertEqual(done.returncode, 2)
        self.assertIn(":1:7: error:", done.stderr)
        self.assertIn(":2:7: error:", done.stderr)


class Prove(Cli):
    DUET = EXAMPLES / "05_duet/duet.pup"

    def prove(self, *arguments):
        return run("prove", *arguments, "-o", self.path / "out")

    def test_exit_codes(self):
        self.assertEqual(self.prove(EXAMPLES / "03_ball/ball.pup").returncode, 0)
        self.assertEqual(self.prove(self.DUET).returncode, 1)
        self.assertEqual(self.prove(self.path / "nothing.pup").returncode, 2)
        self.assertEqual(self.prove(self.DUET, "--rule", "no_such_rule").returncode, 2)
        self.assertEqual(self.prove(self.DUET, "--time", "soon").returncode, 2)
        self.assertEqual(self.prove(self.DUET, "--memory", "much").returncode, 2)
        # No time at all: what structure does not prove is unknown.
        self.assertEqual(self.prove(self.DUET, "--rule", "goes_on", "--time", "0s").returncode, 3)

    def test_long_lines_are_cut_short_unless_all_is_asked_for(self):
        short = self.prove(EXAMPLES / "03_ball/ball.pup").stdout
        full = self.prove(EXAMPLES / "03_ball/ball.pup", "-v").stdout
        self.assertIn(" + ... + ", short)
        self.assertNotIn(" + ... + ", full)
        # Lines below a rule keep to the width; what `-v` tells of a place is told of several at once.
        rest = [line for line in short.splitlines() if not line.startswith(("PROVED", "REFUTED", "UNKNOWN"))]
        self.assertLessEqual(max(len(line) for line in rest), 100)
        self.assertIn("a.flight, b.flight: its movement takes", short)
        self.assertIn("place a.flight: its movement takes", full)
        self.assertIn("puppetri explain", self.prove(self.DUET).stdout)

    def test_a_witness_replays_runs_and_exports(self):
        done = self.prove(self.DUET, "--json")
        answer = {rule["rule"]: rule for rule in json.loads(done.stdout)["rules"]}
        self.assertEqual(answer["everybody"]["answer"], "refuted")
        self.assertEqual(answer["goes_on"]["answer"], "proved")
        witness = answer["everybody"]["witness"]
        steps = json.loads(pathlib.Path(witness).read_text())["steps"]
        log = self.path / "log.csv"
        self.assertEqual(run("run", self.DUET, "--witness", witness, "--log", log).returncode, 0)
        fired = [(int(row["tick"]), row["transition"]) for row in csv.DictReader(io.StringIO(log.read_text()))]
        self.assertEqual(fired[:len(steps)], [(s["tick"], s["transition"]) for s in steps])
        self.assertEqual(run("export", self.DUET, "--witness", witness, "-o", self.path / "bug.glb").returncode, 0)
        self.assertTrue((self.path / "bug.glb").exists())
        # Of another scene it is refused, and so is a damaged one.
        self.assertEqual(run("run", EXAMPLES / "03_ball/ball.pup", "--witness", witness).returncode, 2)
        damaged = self.path / "damaged.json"
        damaged.write_text(pathlib.Path(witness).read_text()[:-20])
        self.assertEqual(run("run", self.DUET, "--witness", damaged).returncode, 2)

    def test_a_repair_is_applied_and_proved(self):
        scene = self.scene(self.DUET.read_text(), "duet.pup")
        done = run("explain", scene, "everybody", "--apply", "-o", self.path / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("keeps_everybody", scene.read_text())
        self.assertEqual(self.prove(scene).returncode, 0)

    def test_a_witness_of_a_net_is_played_to_where_nothing_fires(self):
        net = self.path / "fork.net"
        net.write_text("tr t a -> b\ntr u b -> a\ntr v a -> c\npl a (1)\n")
        done = self.prove(net, "-o", self.path / "out")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        played = run("run", net, "--witness", self.path / "out" / "deadlock_free.witness.json")
        self.assertEqual(played.returncode, 0, played.stderr)
        self.assertIn("after 1 firings: c", played.stderr)
        self.assertIn("nothing can fire any more", played.stderr)
        # Of another net it is refused.
        other = self.path / "other.net"
        other.write_text("tr t a -> b\ntr v a -> c\npl a (1)\n")
        self.assertEqual(run("run", other, "--witness", self.path / "out/deadlock_free.witness.json").returncode, 2)
        # Without a witness: some firings, the same for the same seed.
        hashes = {run("run", net, "--seed", "3", "--for", "5x", "--hash").stdout for _ in range(2)}
        self.assertEqual(len(hashes), 1)

    def test_a_net_without_rules_is_asked_what_one_asks_of_nets(self):
        net = self.path / "ring.net"
        net.write_text("tr t a -> b\ntr u b -> a\npl a (1)\n")
        done = self.prove(net, "--json")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        rules = {rule["rule"] for rule in json.loads(done.stdout)["rules"]}
        self.assertLessEqual({"deadlock_free", "bounded", "live", "quasi_live", "reversible"}, rules)


class Motion(Cli):
    CORPUS = ROOT / "tests/corpus/motion"

    def test_bones_get_the_names_of_another_program(self):
        joints = [("Hips", None), ("Spine", "Hips"), ("Neck", "Spine"), ("Head", "Neck"), ("Tail", "Hips")]
        for side in ("Left", "Right"):
            joints += [(side + "UpLeg", "Hips"), (side + "Leg", side + "UpLeg"), (side + "Foot", side + "Leg")]
        own = self.path / "own.keys"
        own.write_text("keys 1\n" + "".join(f"joint {name} {above or '-'} 0 0.1 0\n" for name, above in joints) +
                       "clip a lasts 1\nrotation LeftUpLeg degrees\n  0 0 0 0\n  1 10 0 0\n")
        for ending in ("bvh", "keys"):
            out = self.path / ("named." + ending)
            done = run("convert", own, out, "--names", "unreal")
            self.assertEqual(done.returncode, 0, done.stderr)
            text = out.read_text()
            for name in ("pelvis", "thigh_l", "calf_r", "foot_l", "head", "Tail"):
                self.assertIn(name, text)
            self.assertNotIn("LeftUpLeg", text)

    def test_motion_is_converted_edited_and_told(self):
        bvh, glb, keys = self.path / "a.bvh", self.path / "a.glb", self.path / "b.keys"
        done = run("convert", self.CORPUS / "walk.keys", bvh, "--clip", "walk", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["files"], [str(bvh)])
        self.assertEqual(run("convert", bvh, glb, "--fps", "50").returncode, 0)
        done = run("clip", glb, "repeat 2", "mirror", "reverse", "-o", keys)
        self.assertEqual(done.returncode, 0, done.stderr)
        told = json.loads(run("clip", keys, "--json").stdout)
        self.assertAlmostEqual(told["clips"][0]["duration_s"], 2, places=2)
        self.assertEqual(run("clip", self.CORPUS / "wave.vrma").returncode, 0)

    def test_clips_are_made_pasted_inserted_and_layered(self):
        nod, out = self.path / "nod.keys", self.path / "out.keys"
        done = run("clip", "-", "--clip", "nod", "key 0 head.flex 0 deg catmull-rom", "key 0.5 head.flex 20 deg",
                   "key 1 head.flex 0 deg", "key 0.5 head.flex 30 deg", "-o", nod)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(nod.read_text(), "keys 1\n\nclip nod lasts 1\nnumber head.flex catmull-rom\n  0 0\n"
                                          "  0.5 0.5235987755982988 linear\n  1 0 linear\n")

        def made(*edits):
            done = run("clip", self.CORPUS / "walk.keys", "--clip", "walk", *edits, "-o", out)
            self.assertEqual(done.returncode, 0, done.stderr)
            return json.loads(run("clip", out, "--json").stdout)["clips"][0]

        # The walk lasts 1 s and has three tracks.
        pasted = made(f"paste 0.2 {nod}")
        self.assertAlmostEqual(pasted["duration_s"], 1.2)
        self.assertEqual(pasted["tracks"], 4)
        self.assertAlmostEqual(made(f"insert 0.5 {nod} nod")["duration_s"], 2)
        # What it differs from its own beginning, on top of itself: twice the way.
        walk = self.CORPUS / "walk.keys"
        for weight, travel in ((1, 2), (0.5, 1.5), (0, 1)):
            layered = made(f"layer {walk} clip walk additive weight {weight}")
            self.assertAlmostEqual(layered["travel_m"], travel, places=4)
        for edit in (f"paste 5 {nod}", f"paste 0 {self.path / 'nobody.keys'}", f"insert 0 {nod} shake", "paste 0",
                     f"layer {nod} loud", f"layer {nod} only nobody", "layer", "key 0 head.flex 20",
                     "key 0 head.flex 20 deg wobbly", "key soon head.flex 20 deg"):
            other = self.path / "other.keys"
            done = run("clip", walk, edit, "-o", other)
            self.assertEqual(done.returncode, 2, edit)
            self.assertTrue(done.stderr)
            self.assertFalse(other.exists())

    def test_tuples_become_absolute_keyframes(self):
        tuples, poses, out = self.path / "dp.tuples", self.path / "poses.keys", self.path / "dp.keys"
        tuples.write_text("0 man1 RESTING\n24 man1 EATING1\n")
        poses.write_text("keys 1\nframes 24\nclip RESTING root root\nnumber head.flex degrees\n 0 0\n"
                         "clip EATING1 root root\nnumber head.flex degrees\n 0 30\n"
                         "clip man1 root root\ntranslation root\n 0 1 0 2\n")
        self.assertEqual(run("convert", tuples, out, "--poses", poses).returncode, 0)
        self.assertIn("clip man1 lasts 1", out.read_text())
        tuples.write_text("0 man1 SLEEPING\n")
        other = self.path / "other.keys"
        self.assertEqual(run("convert", tuples, other, "--poses", poses).returncode, 2)
        self.assertEqual(run("convert", tuples, other).returncode, 2)
        self.assertFalse(other.exists())

    def test_bad_motion_exits_2_and_writes_nothing(self):
        out = self.path / "out.glb"
        text = (self.CORPUS / "dance.bvh").read_text()
        broken = self.path / "broken.bvh"
        for change in (("-40 -50 -60 2e-3", "-40 -50 -60"), ("-40", "nan"), ("Frames: 3", "Frames: 30"),
                       ("0.0333333", "-1"), ("CHANNELS 3", "CHANNELS 4")):
            broken.write_text(text.replace(*change))
            done = run("convert", broken, out)
            self.assertEqual(done.returncode, 2, change)
            self.assertIn("broken.bvh:", done.stderr)
            self.assertIn("help:", done.stderr)
            self.assertFalse(out.exists())
        whole = (self.CORPUS / "wave.glb").read_bytes()
        cut = self.path / "cut.glb"
        cut.write_bytes(whole[:-40])
        self.assertEqual(run("convert", cut, out).returncode, 2)
        self.assertFalse(out.exists())
        # Who is no humanoid has no bones that other programs name.
        for arguments in (["convert", self.CORPUS / "wave.glb", out, "--names", "mixamo"],
                          ["convert", self.CORPUS / "dance.bvh", out, "--scale", "0"],
                          ["convert", self.CORPUS / "dance.bvh", out, "--clip", "nobody"],
                          ["convert", self.CORPUS / "dance.bvh", self.path / "a.vrma"],
                          ["convert", self.CORPUS / "dance.bvh", out, "--onto", "1.7"],
                          ["clip", self.CORPUS / "dance.bvh", "mirror"],
                          ["clip", self.CORPUS / "dance.bvh", "copy 5 9", "-o", out],
                          ["clip", self.CORPUS / "dance.bvh", "twist", "-o", out]):
            done = run(*arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertTrue(done.stderr)
            self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
