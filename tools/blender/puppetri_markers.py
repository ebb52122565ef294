# SPDX-License-Identifier: MIT
"""Turns Puppetri's markers (NAME.events.json) into timeline markers of Blender.

Blender's glTF importer drops the extras of animations, where the markers also are. So: import NAME.glb, then

  in Blender        Scripting > Open this file > Run: adds File > Import > Puppetri markers (.events.json)
  from a terminal   blender ball.blend --background --python tools/blender/puppetri_markers.py -- out/ball.events.json

Markers fall where the importer puts the keys: at t seconds times the scene's frames per second. Set the frame rate of the
scene (Output > Frame Rate) to that of the take before importing the .glb, and they fall on whole frames. Markers of an
earlier import with the same names and frames are not doubled.
"""
import json
import sys

import bpy

VERSION = 1


def read_events(path):
    with open(path, encoding="utf-8") as file:
        content = json.load(file)
    if content.get("version") != VERSION:
        raise ValueError(f"{path}: version {content.get('version')} is not known here (only {VERSION})")
    return content["events"]


def marker_name(event):
    return " ".join(event[key] for key in ("actor", "name", "limb", "prop") if event.get(key))


def add_markers(scene, events):
    """Adds a timeline marker per event; gives how many were new."""
    rate = scene.render.fps / scene.render.fps_base
    known = {(marker.name, marker.frame) for marker in scene.timeline_markers}
    added = 0
    for event in events:
        key = (marker_name(event), round(event["t"] * rate))
        if key not in known:
            scene.timeline_markers.new(key[0], frame=key[1])
            known.add(key)
            added += 1
    return added


class ImportPuppetriMarkers(bpy.types.Operator):
    bl_idname = "import_scene.puppetri_markers"
    bl_label = "Import Puppetri markers"
    bl_options = {"REGISTER", "UNDO"}

    filepath: bpy.props.StringProperty(subtype="FILE_PATH")
    filter_glob: bpy.props.StringProperty(default="*.events.json", options={"HIDDEN"})

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        try:
            added = add_markers(context.scene, read_events(self.filepath))
        except (OSError, ValueError, KeyError) as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{added} markers")
        return {"FINISHED"}


def menu_entry(self, _context):
    self.layout.operator(ImportPuppetriMarkers.bl_idname, text="Puppetri markers (.events.json)")


def register():
    bpy.utils.register_class(ImportPuppetriMarkers)
    bpy.types.TOPBAR_MT_file_import.append(menu_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(menu_entry)
    bpy.utils.unregister_class(ImportPuppetriMarkers)


if __name__ == "__main__":
    if "--" in sys.argv:
        for file_name in sys.argv[sys.argv.index("--") + 1:]:
            print(f"{file_name}: {add_markers(bpy.context.scene, read_events(file_name))} markers")
        if bpy.data.filepath:
            bpy.ops.wm.save_mainfile()
    else:
        register()
