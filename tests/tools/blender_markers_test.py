# SPDX-License-Identifier: MIT
"""The markers script against a stand-in for Blender's module: blender_markers_test.py SCRIPT."""
import importlib.util
import json
import sys
import tempfile
import types
import unittest

SCRIPT = sys.argv.pop(1)


class Markers(list):
    def new(self, name, frame):
        self.append(types.SimpleNamespace(name=name, frame=frame))


def scene(fps, base=1.0):
    return types.SimpleNamespace(render=types.SimpleNamespace(fps=fps, fps_base=base), timeline_markers=Markers())


def load():
    bpy = types.ModuleType("bpy")
    bpy.types = types.SimpleNamespace(Operator=object)
    bpy.props = types.SimpleNamespace(StringProperty=lambda **_: None)
    sys.modules["bpy"] = bpy
    spec = importlib.util.spec_from_file_location("puppetri_markers", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class MarkersTest(unittest.TestCase):
    def setUp(self):
        self.script = load()
        self.events = [
            {"t": 0.75, "frame": 18, "name": "release", "actor": "ana", "limb": "right_arm", "prop": "ball"},
            {"t": 1.0, "frame": 24, "name": "foot_strike", "actor": "rui", "limb": "left_leg", "prop": ""}]

    def test_markers_are_named_and_placed_at_the_rate_of_the_scene(self):
        at_24, at_ntsc = scene(24), scene(60, 1.001)
        self.assertEqual(self.script.add_markers(at_24, self.events), 2)
        self.script.add_markers(at_ntsc, self.events)
        self.assertEqual([(m.name, m.frame) for m in at_24.timeline_markers],
                         [("ana release right_arm ball", 18), ("rui foot_strike left_leg", 24)])
        self.assertEqual([m.frame for m in at_ntsc.timeline_markers], [45, 60])

    def test_a_second_import_doubles_nothing(self):
        twice = scene(24)
        self.script.add_markers(twice, self.events)
        self.assertEqual(self.script.add_markers(twice, self.events), 0)
        self.assertEqual(len(twice.timeline_markers), 2)

    def test_files_of_another_version_are_refused(self):
        with tempfile.NamedTemporaryFile("w", suffix=".events.json") as file:
            json.dump({"version": 99, "events": []}, file)
            file.flush()
            self.assertRaises(ValueError, self.script.read_events, file.name)


unittest.main()
