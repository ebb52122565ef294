#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`puppetri sweep` from outside: ranges, intervals against closed forms, journals, shares, pages.

Usage: sweep_test.py PROGRAM
"""
import csv
import io
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())

SHOP = """scene "A shop"
until 8 h
seed 3

net shop(arrival: time = 12 min, service: time = 6 min, barbers = 1) {
  place queue
  place chair  takes exponential(service)
  place idle   tokens barbers ready
  arrive:             -> queue  after exponential(arrival)
  serve: queue + idle -> chair
  leave: chair        -> idle
}
use shop
"""


class Sweep(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        (self.path / "shop.pup").write_text(SHOP)

    def tearDown(self):
        self.folder.cleanup()

    def sweep(self, *arguments, environment=None, code=0, scene="shop.pup"):
        done = subprocess.run([PROGRAM, "sweep", scene, *map(str, arguments)], capture_output=True, text=True,
                              cwd=self.path, timeout=120, env={**os.environ, **(environment or {})})
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def rows(self, *arguments, **options):
        return list(csv.DictReader(io.StringIO(self.sweep(*arguments, "--csv", "-", **options).stdout)))

    def table(self, name):
        return list(csv.DictReader(io.StringIO((self.path / name).read_text())))

    def test_a_queue_is_as_theory_says(self):
        row, = self.rows("--for", "1000h", "--warm-up", "50h", "--replications", 30, "--level", "99.9%",
                         "--measure", "shop.queue.stay")
        # M/M/1 with rho = 1/2: the mean wait is the mean service time
        self.assertLess(abs(float(row["mean"]) - 360), float(row["half_width"]))
        self.assertLess(float(row["half_width"]), 40)

    def test_ranges_lists_and_combinations(self):
        rows = self.rows("--vary", "shop.barbers=1..3", "--vary", "shop.service=4 min .. 8 min by 2 min",
                         "--replications", 2, "--measure", "shop.chair.busy")
        self.assertEqual([(r["shop.barbers"], r["shop.service"]) for r in rows],
                         [(str(b), f"{s} min") for b in (1, 2, 3) for s in (4, 6, 8)])
        rows = self.rows("--vary", "shop.arrival=0.5 h .. 1 h by 0.25 h", "--replications", 2,
                         "--measure", "shop.chair.busy")
        self.assertEqual([r["shop.arrival"] for r in rows], ["0.5 h", "0.75 h", "1 h"])
        rows = self.rows("--vary", "shop.barbers=2, 5", "--replications", 2, "--measure", "shop.chair.busy")
        self.assertEqual([r["shop.barbers"] for r in rows], ["2", "5"])

    def test_bad_usage_is_told_and_nothing_runs(self):
        for arguments, word in ((("--vary", "shop.barbrs=1..3"), "barbers"), (("--vary", "x"), "PARAMETER"),
                                (("--vary", "shop.barbers=3..1"), "empty"), (("--vary", "shop.arrival=1 h .. 2 h"), "by"),
                                (("--measure", "shop.queue.color"), "no measure"), (("--measure", "shop.q.stay"), "shop.q"),
                                (("--until-half-width", "-1"), "precision"), (("--until-half-width", "1%"), "--measure"),
                                (("--warm-up", "9h"), "warm-up"), (("--replications", "1"), "2")):
            done = self.sweep(*arguments, code=2)
            self.assertIn(word, done.stderr)
            self.assertEqual(done.stdout, "")

    def test_the_numbers_do_not_depend_on_threads(self):
        one, two = (self.sweep("--replications", 40, "--json", "--threads", n).stdout for n in (1, 2))
        self.assertEqual(one, two)

    def test_precision_that_is_asked_for_is_reached(self):
        row, = self.rows("--until-half-width", "4%", "--measure", "shop.chair.busy")
        self.assertGreater(int(row["replications"]), 100)
        self.assertLessEqual(float(row["half_width"]), 0.04 * float(row["mean"]))
        done = self.sweep("--until-half-width", "0.1%", "--at-most", 200, "--measure", "shop.chair.busy")
        self.assertIn("--at-most", done.stderr)

    def test_the_seed_of_each_failing_run_plays_it_again(self):
        (self.path / "fails.pup").write_text("""language 1
scene "A counter that is too small"
until 60 s
data n: 0 .. 20 = 0
place door takes exponential(3 s) tokens 1
come: door -> door set n := n + 1
""")
        done = subprocess.run([PROGRAM, "sweep", "fails.pup", "--replications", "100", "--json"], cwd=self.path,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        failures = json.loads(done.stdout)["points"][0]["failures"]
        self.assertGreater(len(failures), 20)
        self.assertIn(f"--seed {failures[0]['seed']}", done.stderr)
        for failure in failures:
            again = subprocess.run([PROGRAM, "run", "fails.pup", "--seed", str(failure["seed"])], cwd=self.path,
                                   capture_output=True, text=True)
            self.assertIn("n would leave its range", again.stderr)
            self.assertEqual(again.returncode, 1)
        large = subprocess.run([PROGRAM, "run", "fails.pup", "--seed", str(2 ** 63)], cwd=self.path,
                               capture_output=True, text=True)
        self.assertEqual(large.returncode, 2)
        self.assertIn("whole number", large.stderr)

    def test_equations_are_measured_in_runs_and_sweeps(self):
        # x' = -x/s from 1, and n that jumps to x whenever the bell rings: means over 4 s
        (self.path / "decay.pup").write_text("""language 1
scene "Decay"
until 4 s
equations decays(bell: transition) {
  x starts at 1
  x.rate = -x/1 s
  double = 2*x
  on bell set x := 1
}
place waits takes 1 .. 3 s tokens 1
bell: waits ->
use decays(bell) as d
measure level mean of d.x
measure twice mean of d.double
measure at_last final of d.x
measure high most of d.x
measure rang total of time in waits
""")
        done = subprocess.run([PROGRAM, "run", "decay.pup", "--json"], cwd=self.path, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = json.loads(done.stdout)["measures"]
        rang = found["rang"]["value"]
        level = (2 - math.exp(-rang) - math.exp(rang - 4)) / 4
        self.assertAlmostEqual(found["level"]["value"], level, places=7)
        self.assertAlmostEqual(found["twice"]["value"], 2 * level, places=7)
        self.assertAlmostEqual(found["at_last"]["value"], math.exp(rang - 4), places=7)
        self.assertAlmostEqual(found["high"]["value"], 1, places=9)
        # Over many runs: E level with the bell uniform on 1 .. 3 s
        csv_text = subprocess.run([PROGRAM, "sweep", "decay.pup", "--replications", "400", "--csv", "-"], cwd=self.path,
                                  capture_output=True, text=True).stdout
        row = {r["measure"]: r for r in csv.DictReader(io.StringIO(csv_text))}["level"]
        truth = (2 - (math.exp(-1) - math.exp(-3))) / 4
        self.assertLess(abs(float(row["mean"]) - truth), 2 * float(row["half_width"]) + 1e-4)
        refused = subprocess.run([PROGRAM, "solve", "decay.pup", "--measure", "level"], cwd=self.path, capture_output=True,
                                 text=True)
        self.assertIn(refused.returncode, (2, 3))

    def test_a_killed_sweep_goes_on_to_the_same_numbers(self):
        arguments = ["--for", "400h", "--replications", "4000", "--journal", "journal", "--measure", "shop.queue.stay",
                     "--csv", "-"]
        whole = self.rows(*[a for a in arguments if a not in ("--journal", "journal", "--csv", "-")])
        killed = subprocess.Popen([PROGRAM, "sweep", "shop.pup", *arguments], cwd=self.path, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL)
        journal = self.path / "journal" / "rank-0.txt"
        for _ in range(1000):
            if journal.exists() and journal.read_text().count("\n") > 50:
                break
            time.sleep(0.01)
        killed.send_signal(signal.SIGKILL)
        killed.wait()
        lines = journal.read_text().count("\n")
        self.assertGreater(lines, 50)
        self.assertLess(lines, 4000)
        with journal.open("a") as f:
            f.write("0 3999 0x1.2")  # cut off in the middle of a line
        rows = list(csv.DictReader(io.StringIO(self.sweep(*arguments).stdout)))
        self.assertEqual(rows, whole)
        done = self.sweep(*arguments, "--seed", 5, code=2)
        self.assertIn("other-sweep", done.stderr)

    def test_processes_share_a_sweep(self):
        arguments = ["--replications", 31, "--measure", "shop.queue.stay"]
        whole = self.rows(*arguments)
        # A Slurm array: one after another, the last one tells
        for task in (1, 2, 3):
            done = self.sweep(*arguments, "--journal", "array", "--csv", "array.csv",
                              environment={"SLURM_ARRAY_TASK_ID": str(task), "SLURM_ARRAY_TASK_MIN": "1",
                                           "SLURM_ARRAY_TASK_COUNT": "3"})
            self.assertEqual((self.path / "array.csv").exists(), task == 3, done.stderr)
        self.assertEqual(self.table("array.csv"), whole)
        # Open MPI: together, in stages
        precise = ["--until-half-width", "20%", "--replications", 31, "--measure", "shop.queue.stay"]
        whole = self.rows(*precise)
        processes = [subprocess.Popen([PROGRAM, "sweep", "shop.pup", *map(str, precise), "--journal", "mpi", "--csv",
                                       "mpi.csv"], cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                      env={**os.environ, "OMPI_COMM_WORLD_RANK": str(r), "OMPI_COMM_WORLD_SIZE": "3"})
                     for r in range(3)]
        told = [p.communicate(timeout=120)[0] for p in processes]
        self.assertEqual([bool(t) for t in told], [True, False, False])
        self.assertEqual(self.table("mpi.csv"), whole)

    def test_measures_that_the_scene_declares(self):
        (self.path / "declared.pup").write_text(SHOP.replace("}\nuse shop", """  measure wait "time in the queue" mean of time in queue
  measure sojourn mean of time from arrive to leave
  measure slow percentile 90 of time from arrive to leave
  measure busy share of #chair > 0
  measure served count of leave
}
use shop""").replace("8 h", "400 h"))
        rows = self.rows("--replications", 30, "--warm-up", "20h", "--level", "99.9%", scene="declared.pup")
        by_name = {r["measure"]: r for r in rows}
        self.assertEqual(list(by_name), ["shop." + m for m in ("wait", "sojourn", "slow", "busy", "served")])
        # M/M/1 with rho = 1/2 and a service of 360 s: the sojourn is exponential with mean 720 s
        for name, truth in (("wait", 360), ("sojourn", 720), ("slow", 720 * 2.302585), ("busy", 0.5)):
            row = by_name["shop." + name]
            self.assertLess(abs(float(row["mean"]) - truth), float(row["half_width"]), name)
            self.assertLess(float(row["half_width"]), 0.2 * truth, name)
        # One run, and the chain solved
        done = subprocess.run([PROGRAM, "run", "declared.pup", "--for", "40h", "--json"], cwd=self.path, capture_output=True, text=True,
                              timeout=60)
        measures = json.loads(done.stdout)["measures"]
        self.assertEqual(measures["shop.wait"]["caption"], "time in the queue")
        self.assertGreater(measures["shop.served"]["value"], 100)
        self.assertIn("replications", by_name["shop.wait"])
        text = subprocess.run([PROGRAM, "run", "declared.pup", "--for", "8h"], cwd=self.path, capture_output=True, text=True, timeout=60)
        self.assertIn("time in the queue", text.stdout)

    def test_what_was_never_seen_has_no_mean(self):
        (self.path / "rare.pup").write_text(SHOP.replace("}\nuse shop", "  measure wait mean of time in queue\n}\nuse shop")
                                            .replace("8 h", "5 min"))
        row, = self.rows("--replications", 200, scene="rare.pup")
        # Somebody is served within 5 minutes, with arrivals every 12, in 34 % of the runs
        self.assertTrue(40 < int(row["replications"]) < 100, row)
        (self.path / "never.pup").write_text((self.path / "rare.pup").read_text().replace("5 min", "1 ms"))
        row, = self.rows("--replications", 5, scene="never.pup")
        self.assertEqual((row["replications"], row["mean"]), ("0", ""))
        self.assertIn("-", self.sweep("--replications", 5, "--all", scene="never.pup").stdout)

    def test_one_long_run_in_batches(self):
        row, = self.rows("--for", "20000h", "--warm-up", "auto", "--batches", "auto", "--measure", "shop.queue.stay",
                         "--level", "99.9%")
        self.assertGreaterEqual(int(row["replications"]), 16)
        self.assertLess(abs(float(row["mean"]) - 360), float(row["half_width"]))
        self.assertLess(float(row["half_width"]), 40)
        row, = self.rows("--for", "200h", "--batches", 20, "--measure", "shop.chair.busy", "--until-half-width", "3%")
        self.assertGreater(int(row["replications"]), 20)
        self.assertLessEqual(float(row["half_width"]), 0.03 * float(row["mean"]))
        done = self.sweep("--for", "40h", "--vary", "shop.service=13 min, 14 min", "--warm-up", "auto", "--measure",
                          "shop.queue.tokens", code=1)
        self.assertIn("not-settled", done.stderr)  # a queue that grows
        self.assertIn("--batches", self.sweep("--batches", "1", code=2).stderr)
        self.assertIn("--batches", self.sweep("--batches", "10", "--replications", "10", code=2).stderr)

    def test_logs_are_compared_and_replayed(self):
        def tool(*arguments, code):
            done = subprocess.run([PROGRAM, *arguments], cwd=self.path, capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
            return done.stdout if "--json" in arguments else done.stdout + done.stderr
        for seed in (3, 4):
            tool("run", "shop.pup", "--seed", str(seed), "--log", f"{seed}.csv", code=0)
        self.assertIn("the same", tool("compare", "3.csv", "3.csv", code=0))
        self.assertIn("the same", tool("compare", "3.csv", "shop.pup", code=0))
        told = tool("compare", "3.csv", "4.csv", "--on", "shop.pup", code=1)
        self.assertIn("shop.arrive", told)
        self.assertIn("the net can do all of it", tool("replay", "shop.pup", "3.csv", code=0))
        # Cut: three lines, then one that cannot be
        lines = (self.path / "3.csv").read_text().splitlines()
        changed = lines[:4] + [lines[4].rsplit(",", 1)[0] + ",shop.leave"] * 2
        (self.path / "broken.csv").write_text("\n".join(changed) + "\n")
        one = json.loads(tool("compare", "3.csv", "broken.csv", "--json", "--on", "shop.pup", code=1).splitlines()[0])
        self.assertIn(one["common"], (3, 4))
        told = tool("replay", "shop.pup", "broken.csv", code=1)
        self.assertIn("broken.csv:", told)
        self.assertIn("shop.chair", told)
        # From a till: other names, seconds with two digits, no head line, services not logged
        till = [f"{int(t) / 705600000:.2f};{'in' if name.endswith('arrive') else 'paid'};-"
                for t, _, name in (line.split(",") for line in lines[1:]) if not name.endswith("serve")]
        (self.path / "till.csv").write_text("\n".join(till) + "\n")
        names = ("--map", "in=shop.arrive", "--map", "paid=shop.leave")
        self.assertIn("help", tool("replay", "shop.pup", "till.csv", code=2))
        self.assertIn("leaves out", tool("replay", "shop.pup", "till.csv", *names, "--unlogged", "--tolerance", "10ms", code=0))
        till.insert(0, "0.00;paid;-")
        (self.path / "till.csv").write_text("\n".join(till) + "\n")
        self.assertIn("till.csv:1", tool("replay", "shop.pup", "till.csv", *names, "--unlogged", "--tolerance", "10ms", code=1))

    def test_under_mpirun_the_numbers_are_those_of_one_process(self):
        """Open MPI itself; the program is not linked with it and finds its rank in the environment."""
        if shutil.which("mpirun") is None:
            self.skipTest("skipped: there is no mpirun")
        for which, arguments in enumerate((["--replications", 31, "--measure", "shop.queue.stay"],
                          ["--until-half-width", "20%", "--replications", 31, "--measure", "shop.queue.stay",
                           "--vary", "shop.barbers=1..2"],
                          ["--batches", 12, "--warm-up", "1h", "--vary", "shop.barbers=1..2", "--measure", "shop.chair.busy"])):
            whole = self.rows(*arguments)
            for ranks in (1, 2, 3):
                name = f"mpi-{ranks}.csv"
                journal = f"mpi-{ranks}-{which}"
                done = subprocess.run(
                    ["mpirun", "--oversubscribe", "--bind-to", "none", *(["--allow-run-as-root"] if os.getuid() == 0 else []),
                     "-n", str(ranks), PROGRAM, "sweep", "shop.pup", *map(str, arguments), "--threads", "1",
                     "--journal", journal, "--csv", name], cwd=self.path, capture_output=True, text=True, timeout=300)
                if done.returncode != 0 and "puppetri" not in done.stderr and "error:" not in done.stderr:
                    self.skipTest("skipped: mpirun starts nothing here: " + done.stderr[:200])
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(self.table(name), whole)

    def test_as_a_slurm_array_the_numbers_are_those_of_one_process(self):
        if shutil.which("sbatch") is None:
            self.skipTest("skipped: there is no sbatch")
        try:
            up = subprocess.run(["sinfo", "-h", "-o", "%T"], capture_output=True, text=True, timeout=10)
        except subprocess.TimeoutExpired:
            self.skipTest("skipped: Slurm does not answer")
        if up.returncode != 0 or not any(w in up.stdout for w in ("idle", "mixed", "allocated")):
            self.skipTest("skipped: no Slurm node is up")
        arguments = ["--replications", 31, "--measure", "shop.queue.stay"]
        whole = self.rows(*arguments)
        command = " ".join([PROGRAM, "sweep", "shop.pup", *map(str, arguments), "--threads", "1", "--journal", "slurm",
                            "--csv", "slurm.csv"])
        done = subprocess.run(["sbatch", "--wait", "--array=1-3", "--output", str(self.path / "slurm-%a.txt"), "--chdir",
                               str(self.path), "--wrap", command], cwd=self.path, capture_output=True, text=True,
                              timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.table("slurm.csv"), whole)

    def test_a_failing_run_is_told_with_its_seed_and_the_others_go_on(self):
        (self.path / "fragile.pup").write_text("""scene "Counts to twenty"
until 20 s
data count: 0 .. 20 = 0
place bell
ring: -> bell after exponential(1 s) set count := count + 1
""")
        done = self.sweep("--replications", 60, "--json", scene="fragile.pup")
        point, = json.loads(done.stdout)["points"]
        failures = point["failures"]
        self.assertGreater(len(failures), 5)
        self.assertEqual(len(failures) + point["replications"], 60)
        again = subprocess.run([PROGRAM, "run", "fragile.pup", "--seed", failures[0]["seed"]], cwd=self.path,
                               capture_output=True, text=True, timeout=60)
        self.assertNotEqual(again.returncode, 0)

    def test_figures_can_be_on_stage(self):
        (self.path / "walk.pup").write_text("""scene "Somebody turns now and then"
until 60 s
cast { ana: mannequin }
place rest  takes exponential(2 s)  tokens 1
place turning  does ana.face(90 deg)  takes auto
place back  does ana.face(0 deg)  takes auto
go: rest -> turning
come: turning -> back
stay: back -> rest
""")
        rows = self.rows("--replications", 3, "--measure", "turning.stay", scene="walk.pup")
        self.assertGreater(float(rows[0]["mean"]), 0.1)

    def test_what_is_solved_is_what_is_simulated_and_what_theory_says(self):
        (self.path / "room.pup").write_text(SHOP.replace("place queue", "place free tokens 6\n  place queue")
                                            .replace("arrive:             -> queue", "arrive: free -> queue")
                                            .replace("-> idle\n", "-> idle + free\n  state full = not free\n"))
        solved = subprocess.run([PROGRAM, "solve", "room.pup", "--json"], cwd=self.path, capture_output=True, text=True,
                                timeout=60)
        self.assertEqual(solved.returncode, 0, solved.stderr)
        answer = json.loads(solved.stdout)
        self.assertEqual(answer["states"], 7)
        self.assertLess(answer["residual"], 1e-12)
        empty = (1 - 0.5) / (1 - 0.5 ** 7)  # M/M/1/6 with rho = 1/2
        self.assertAlmostEqual(answer["values"]["shop.chair.busy"], 1 - empty, places=10)
        row, = self.rows("--for", "2000h", "--warm-up", "10h", "--replications", 20, "--level", "99.9%",
                         "--measure", "shop.queue.stay", scene="room.pup")
        self.assertLess(abs(float(row["mean"]) - answer["values"]["shop.queue.stay"]), float(row["half_width"]))
        reached = subprocess.run([PROGRAM, "solve", "room.pup", "--reach", "shop.full", "--within", "3h", "--json"],
                                 cwd=self.path, capture_output=True, text=True, timeout=60)
        values = json.loads(reached.stdout)["values"]
        self.assertGreater(values["mean time to shop.full"], 3600)
        self.assertTrue(0 < values["P(shop.full within 3h)"] < 1)

    def test_what_cannot_be_solved_is_unknown_and_says_why(self):
        (self.path / "fixed.pup").write_text(SHOP.replace("exponential(service)", "service"))
        done = subprocess.run([PROGRAM, "solve", "fixed.pup"], cwd=self.path, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 3)
        self.assertIn("shop.chair", done.stderr)
        done = subprocess.run([PROGRAM, "solve", "shop.pup", "--at", "1h", "--time", "1s"], cwd=self.path, capture_output=True,
                              text=True, timeout=60)
        self.assertEqual(done.returncode, 3)
        self.assertIn("infinitely", done.stderr)

    def test_an_endless_queue_has_a_product_form_unless_it_grows(self):
        done = subprocess.run([PROGRAM, "solve", "shop.pup", "--json"], cwd=self.path, capture_output=True, text=True,
                              timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        answer = json.loads(done.stdout)
        self.assertEqual(answer["stations"], 1)
        self.assertAlmostEqual(answer["values"]["shop.queue.stay"], 360, places=9)  # M/M/1 with rho = 1/2
        self.assertAlmostEqual(answer["values"]["shop.chair.busy"], 0.5, places=12)
        (self.path / "grows.pup").write_text(SHOP.replace("service: time = 6 min", "service: time = 13 min"))
        done = subprocess.run([PROGRAM, "solve", "grows.pup"], cwd=self.path, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("grows without bound", done.stderr)
        done = subprocess.run([PROGRAM, "sweep", "grows.pup", "--replications", "5"], cwd=self.path, capture_output=True,
                              text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("grows-without-bound", done.stderr)

    def test_tables_show_two_digits_of_the_interval_and_as_many_of_the_mean(self):
        arguments = ["--replications", 50, "--measure", "shop.queue.stay", "--measure", "shop.chair.busy"]
        lines = {l.split()[0]: l.split() for l in self.sweep(*arguments).stdout.splitlines()[1:]}
        rows = self.rows(*arguments)
        self.assertEqual({r["measure"] for r in rows}, set(lines))
        for row in rows:
            _, mean, half_width, *_ = lines[row["measure"]]
            exact = float(row["half_width"])
            last = 10.0 ** (math.floor(math.log10(exact)) - 1)  # of the digits that are shown
            self.assertNotIn("e", mean + half_width)
            self.assertAlmostEqual(float(half_width), exact, delta=0.51 * last)
            self.assertAlmostEqual(float(mean), float(row["mean"]), delta=0.51 * last)

    def test_the_page_stands_alone(self):
        self.sweep("--vary", "shop.barbers=1..3", "--replications", 20, "--html", "page.html")
        page = (self.path / "page.html").read_text()
        self.assertTrue(page.startswith("<!doctype html>"))
        self.assertIn("shop.queue.stay", page)
        self.assertIn("<svg", page)
        for outside in ("http:", "https:", "src=", "@import"):
            self.assertNotIn(outside, page)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
