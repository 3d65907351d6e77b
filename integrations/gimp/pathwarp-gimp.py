#!/usr/bin/env python3
"""pathwarp for GIMP 3: bends a path by others, chosen by name (menu of the Paths dialogue, and Filters > pathwarp).

Points go to the program `pathwarp` and come back as they are (PDB point lists, JSON), not as SVG text. The program is looked for
beside this file (bin/pathwarp), where PATHWARP says, and on the PATH. `pathwarp install gimp` puts both in place.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile

import gi

gi.require_version("Gimp", "3.0")
from gi.repository import Gimp, GLib, GObject  # noqa: E402

# A deformation: its title, what it does, and its arguments: name, kind, label, tip, default. "path" arguments name paths of the
# image; the program knows what a "choice" is among; a "side" is 1 to 4.
DEFORMATIONS = {
    "shaper": ("Shaper…", "Bend a path into a closed path of four sides", [
        ("shaper", "path", "_Shaper", "The closed path of four sides", ""),
        ("base", "path", "_Base", "The path's frame: 2 or 4 anchors; none: its box", ""),
        ("target", "path", "_Target", "Where the result goes: as many anchors as the Base; none: the Shaper's place", ""),
        ("bottom", "side", "B_ottom side", "The Shaper's side that is the bottom, in the order they were drawn", ""),
        ("reverse-shaper", "flag", "_Reverse Shaper", "Run the bottom side the other way", False),
        ("base-as-drawn", "flag", "Base as _drawn", "Take the Base's anchors in the order they were drawn", False),
        ("target-as-drawn", "flag", "Target as dra_wn", "Take the Target's anchors in the order they were drawn", False),
    ]),
    "bend": ("Bend along…", "Bend a path along another", [
        ("along", "path", "_Along", "The path to bend along", ""),
        ("as-drawn", "flag", "As _drawn", "Take it in the direction it was drawn", False),
        ("reverse", "flag", "_Reverse", "Run it the other way", False),
    ]),
    "warp": ("Warp…", "Bend a path in a style", [
        ("style", "choice", "_Style", "The style", "arc"),
        ("bend", "percent", "_Bend", "How far, and which way: -100% to 100%", "50%"),
        ("axis", "choice", "_Axis", "The direction in which the path runs through the style", "horizontal"),
        ("horizontal", "percent", "_Horizontal", "Distortion: -100% to 100%", "0%"),
        ("vertical", "percent", "_Vertical", "Distortion: -100% to 100%", "0%"),
        ("keep", "choice", "_Keep straight", "What stays straight, in the styles that allow it", "nothing"),
    ]),
    "wordart": ("Text shape…", "Put a path into a text shape of office programs", [
        ("preset", "choice", "_Shape", "The shape", "wave1"),
        ("adj", "text", "_Adjust", "The shape's first adjust value: 1/100000 of the box or %; empty: as it comes", ""),
    ]),
}


# What every deformation asks for first.
PATH = ("path", "path", "_Path", "The path to bend; empty: the selected one", "")
# Guides without which there is nothing to do.
REQUIRED = {"shaper", "along"}


def program():
    """The program, or None."""
    name = "pathwarp.exe" if os.name == "nt" else "pathwarp"
    beside = os.path.join(os.path.dirname(os.path.realpath(__file__)), "bin", name)
    for candidate in (os.environ.get("PATHWARP"), beside, shutil.which("pathwarp")):
        if candidate and os.path.isfile(candidate):
            return candidate
    return None


def run_program(arguments):
    """Standard output of the program; raises RuntimeError with what it says when it fails."""
    found = program()
    if not found:
        raise RuntimeError("The program pathwarp is missing; `pathwarp install gimp` puts it beside this plug-in.")
    flags = getattr(subprocess, "CREATE_NO_WINDOW", 0)
    done = subprocess.run([found, *arguments], stdin=subprocess.DEVNULL, capture_output=True, creationflags=flags)
    if done.returncode not in (0, 1):
        raise RuntimeError(done.stderr.decode("utf-8", "replace").strip() or "pathwarp failed")
    return done.stdout, done.stderr.decode("utf-8", "replace").strip()


def known():
    """The deformations that the program has."""
    try:
        listed = run_program(["list"])[0].decode("utf-8", "replace")
    except (RuntimeError, OSError):
        return list(DEFORMATIONS)
    words = {line.split()[0] for line in listed.splitlines() if line.startswith("  ") and line.split()}
    return [name for name in DEFORMATIONS if name in words]


def point_list(path):
    """A path with its exact points, as JSON data."""
    strokes = []
    for stroke in path.get_strokes():
        kind, points, closed = path.stroke_get_points(stroke)
        strokes.append({"type": int(kind), "closed": bool(closed), "num_points": len(points), "controlpoints": list(points)})
    return {"name": path.get_name(), "visible": bool(path.get_visible()), "strokes": strokes}


def named(image, name):
    for path in image.get_paths():
        if path.get_name() == name:
            return path
    raise RuntimeError("There is no path of the name “%s” in this image." % name)


def without(file, text):
    """A message without the name of a file that is gone by then."""
    return text.replace(file + "#", "").replace(file + ": ", "")


def deform(image, deformation, path, values):
    """Deforms `path` and adds the result to the image as a new path, which is given back."""
    folder = tempfile.mkdtemp(prefix="pathwarp-")
    try:
        arguments = [deformation]
        source = os.path.join(folder, "paths.json")
        result = os.path.join(folder, "result.json")
        used = {path.get_name(): path}
        for name, kind, _label, _tip, _default in DEFORMATIONS[deformation][2]:
            value = values.get(name)
            if kind == "flag":
                if value:
                    arguments.append("--" + name)
            elif value:
                if kind == "path":
                    used[value] = named(image, value)
                    value = source + "#" + value
                arguments += ["--" + name, value]
        arguments += (values.get("options") or "").split()
        # A guide may be the path itself: the file's paths are looked up by name, the input is one of them.
        data = {"width": image.get_width(), "height": image.get_height(), "paths": [point_list(p) for p in used.values()]}
        with open(source, "w", encoding="utf-8") as file:
            json.dump(data, file)
        try:
            said = run_program(arguments + [source + "#" + path.get_name(), "-o", result])[1]
        except RuntimeError as e:
            raise RuntimeError(without(source, str(e))) from None
        if said:
            Gimp.message(without(source, said))
        with open(result, encoding="utf-8") as file:
            warped = json.load(file)["paths"]
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    if not warped:
        raise RuntimeError("The path “%s” has no strokes to bend." % path.get_name())
    image.undo_group_start()
    try:
        new = Gimp.Path.new(image, "%s %s" % (path.get_name(), deformation))
        for stroke in warped[0]["strokes"]:
            new.stroke_new_from_points(Gimp.PathStrokeType.BEZIER, stroke["controlpoints"], stroke["closed"])
        image.insert_path(new, None, 0)
        new.set_visible(True)
    finally:
        image.undo_group_end()
    Gimp.displays_flush()
    return new


def ask(image, procedure, config, deformation):
    """The dialogue; whether it was confirmed."""
    gi.require_version("GimpUi", "3.0")
    gi.require_version("Gtk", "3.0")
    from gi.repository import GimpUi, Gtk

    GimpUi.init("pathwarp-gimp")
    title, _blurb, arguments = DEFORMATIONS[deformation]
    dialog = GimpUi.Dialog(title=title.replace("…", ""), role="pathwarp-" + deformation)
    dialog.add_button("_Cancel", Gtk.ResponseType.CANCEL)
    dialog.add_button("_OK", Gtk.ResponseType.OK)
    dialog.set_default_response(Gtk.ResponseType.OK)
    grid = Gtk.Grid(column_spacing=12, row_spacing=6, margin=12)
    dialog.get_content_area().add(grid)
    paths = guesses(image, config, arguments)
    fields = {}
    for row, (name, kind, label, tip, default) in enumerate([PATH] + arguments):
        stored = config.get_property(name) or ""
        if kind == "flag":
            field = Gtk.CheckButton(label=label, use_underline=True, active=bool(stored))
            grid.attach(field, 1, row, 1, 1)
        else:
            if kind == "text":
                field = Gtk.Entry(text=stored, activates_default=True)
            elif kind == "percent":
                field = Gtk.SpinButton.new_with_range(-100, 100, 1)
                field.set_digits(1)
                field.set_value(percent(stored, default))
                field.set_activates_default(True)
            else:
                field = Gtk.ComboBoxText()
                if kind == "path":
                    listed, value = paths[name]
                elif kind == "side":
                    listed, value = ["", "1", "2", "3", "4"], stored
                else:
                    listed, value = choices(deformation, name), stored
                    # A file of one's own.
                    listed += [stored] if stored not in listed else []
                for choice in listed:
                    field.append(choice, choice or ("(the lowest)" if kind == "side" else "(none)"))
                field.set_active_id(value)
            field.set_hexpand(True)
            caption = Gtk.Label(label=label + (" (%)" if kind == "percent" else ""), use_underline=True, xalign=0)
            caption.set_mnemonic_widget(field)
            grid.attach(caption, 0, row, 1, 1)
            grid.attach(field, 1, row, 1, 1)
        field.set_tooltip_text(tip)
        fields[name] = (kind, field)
    dialog.show_all()
    confirmed = dialog.run() == Gtk.ResponseType.OK
    if confirmed:
        for name, (kind, field) in fields.items():
            if kind == "flag":
                value = field.get_active()
            elif kind == "percent":
                value = "%g%%" % round(field.get_value(), 1)
            else:
                value = field.get_text() if kind == "text" else field.get_active_id()
            config.set_property(name, value if kind == "flag" else value or "")
    dialog.destroy()
    return confirmed


def percent(text, default):
    """A share as the dialogue shows it; scripts may have given it as a plain number, too."""
    for candidate in (text, default):
        try:
            return float(candidate[:-1]) if candidate.endswith("%") else 100 * float(candidate)
        except ValueError:
            pass
    return 0


def guesses(image, config, arguments):
    """For every argument that is a path: the names to choose among, and the one that is most likely meant."""
    names = [path.get_name() for path in image.get_paths()]
    selected = [path.get_name() for path in image.get_selected_paths()]
    roles = [name for name, kind, *_ in arguments if kind == "path"]
    found = {}
    for role in roles:
        stored = config.get_property(role)
        # The names that the first plug-in's users give their paths.
        found[role] = stored if stored in names else next((n for n in names if n.lower() == role), "")
    # What is bent is no guide, if there is a choice.
    free = [n for n in selected + names if n not in found.values() and n.lower() not in roles]
    path = (free or selected or names)[0]
    for role in REQUIRED.intersection(roles):
        found[role] = found[role] or next((n for n in selected + names if n != path), path)
    return {"path": (names, path)} | {r: (names if r in REQUIRED else [""] + names, n) for r, n in found.items()}


def choices(deformation, argument):
    """What the program knows for an argument of kind "choice"; empty if it cannot be asked."""
    try:
        schema = json.loads(run_program(["schema"])[0])
    except (RuntimeError, OSError, ValueError):
        return []
    for step in schema["properties"]["step"]["items"]["oneOf"]:
        properties = step["properties"]
        if properties["deformation"].get("const") == deformation:
            found = properties[argument]
            return found.get("enum") or found.get("examples") or []
    return []


def run(procedure, run_mode, image, _drawables, config, deformation):
    def stop(status, why=""):
        return procedure.new_return_values(status, GLib.Error(why) if why else GLib.Error())

    if not image.get_paths():
        return stop(Gimp.PDBStatusType.CALLING_ERROR, "This image has no paths.")
    if run_mode == Gimp.RunMode.INTERACTIVE and not ask(image, procedure, config, deformation):
        return stop(Gimp.PDBStatusType.CANCEL)
    values = {name: config.get_property(name) for name, *_ in DEFORMATIONS[deformation][2]}
    values["options"] = config.get_property("options")
    try:
        name = config.get_property("path")
        selected = image.get_selected_paths()
        if not name and not selected:
            return stop(Gimp.PDBStatusType.CALLING_ERROR, "No path is selected.")
        new = deform(image, deformation, named(image, name) if name else selected[0], values)
    except (RuntimeError, OSError, ValueError, KeyError) as e:
        return stop(Gimp.PDBStatusType.EXECUTION_ERROR, str(e))
    answer = stop(Gimp.PDBStatusType.SUCCESS)
    answer.remove(1)
    answer.insert(1, GObject.Value(Gimp.Path, new))
    return answer


class Pathwarp(Gimp.PlugIn):
    def do_set_i18n(self, _name):
        return False

    def do_query_procedures(self):
        return ["plug-in-pathwarp-" + name for name in known()]

    def do_create_procedure(self, name):
        deformation = name.removeprefix("plug-in-pathwarp-")
        title, blurb, arguments = DEFORMATIONS[deformation]
        procedure = Gimp.ImageProcedure.new(self, name, Gimp.PDBProcType.PLUGIN, run, deformation)
        procedure.set_image_types("*")
        procedure.set_sensitivity_mask(
            Gimp.ProcedureSensitivityMask.DRAWABLE
            | Gimp.ProcedureSensitivityMask.DRAWABLES
            | Gimp.ProcedureSensitivityMask.NO_DRAWABLES
        )
        procedure.set_menu_label(title)
        procedure.add_menu_path("<Paths>/pathwarp")
        procedure.add_menu_path("<Image>/Filters/pathwarp")
        procedure.set_documentation(blurb, "Paths are chosen by name. The result is a new path.", name)
        procedure.set_attribution("The pathwarp authors", "The pathwarp authors", "2026")
        both = GObject.ParamFlags.READWRITE
        for argument, kind, label, tip, default in [PATH] + arguments:
            if kind == "flag":
                procedure.add_boolean_argument(argument, label, tip, default, both)
            else:
                procedure.add_string_argument(argument, label, tip, default, both)
        procedure.add_string_argument("options", "_Options", "Further options of the command line", "", both)
        procedure.add_path_return_value("result", "Result", "The new path", False, both)
        return procedure


Gimp.main(Pathwarp.__gtype__, sys.argv)
