#!/usr/bin/env python3
"""pathwarp for GIMP 3: deforms a path by other paths, chosen by name (Paths dialog, and Filters > pathwarp).

Exchanges exact points with the program `pathwarp` (point lists in JSON, not SVG). Looks for the program in the environment variable
PATHWARP, beside this file (bin/pathwarp), and on the PATH. `pathwarp install gimp` installs both.
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

# For each deformation: title, description, and arguments as (name, kind, label, tip, default). A "path" names a path of the image,
# the program lists the values of a "choice", and a "side" is 1 to 4.
DEFORMATIONS = {
    "shaper": ("Shaper…", "Bend a path into a closed path with four sides", [
        ("shaper", "path", "_Shaper", "The closed path with four sides", ""),
        ("base", "path", "_Base", "The frame of the path: 2 or 4 anchors. Without a Base, its bounding box", ""),
        ("target", "path", "_Target", "The place of the result: as many anchors as the Base. Without a Target, the place of the Shaper", ""),
        ("bottom", "side", "B_ottom side", "The number of the Shaper's bottom side, in drawing order", ""),
        ("reverse-shaper", "flag", "_Reverse Shaper", "Reverse the direction of the bottom side", False),
        ("base-as-drawn", "flag", "Base as _drawn", "Keep the drawing order of the Base's anchors", False),
        ("target-as-drawn", "flag", "Target as dra_wn", "Keep the drawing order of the Target's anchors", False),
    ]),
    "bend": ("Bend along…", "Bend a path along another", [
        ("along", "path", "_Along", "The path to bend along", ""),
        ("as-drawn", "flag", "As _drawn", "Keep the direction in which it was drawn", False),
        ("reverse", "flag", "_Reverse", "Reverse its direction", False),
    ]),
    "warp": ("Warp…", "Bend a path in a style", [
        ("style", "choice", "_Style", "The style", "arc"),
        ("bend", "percent", "_Bend", "Amount and direction: -100% to 100%", "50%"),
        ("axis", "choice", "_Axis", "The axis of the style", "horizontal"),
        ("horizontal", "percent", "_Horizontal", "Distortion: -100% to 100%", "0%"),
        ("vertical", "percent", "_Vertical", "Distortion: -100% to 100%", "0%"),
        ("keep", "choice", "_Keep straight", "Lines to keep straight, in styles that allow it", "nothing"),
    ]),
    "wordart": ("Text shape…", "Put a path into a text shape known from office programs", [
        ("preset", "choice", "_Shape", "The shape", "wave1"),
        ("adj", "text", "_Adjust", "The first adjust value of the shape, in 1/100000 of the box or in %. Empty: the default", ""),
    ]),
}


# The first argument of every deformation.
PATH = ("path", "path", "_Path", "The path to bend. Empty: the selected path", "")
# Guides that a deformation cannot do without.
REQUIRED = {"shaper", "along"}


def program():
    """Return the path of the program, or None."""
    name = "pathwarp.exe" if os.name == "nt" else "pathwarp"
    beside = os.path.join(os.path.dirname(os.path.realpath(__file__)), "bin", name)
    for candidate in (os.environ.get("PATHWARP"), beside, shutil.which("pathwarp")):
        if candidate and os.path.isfile(candidate):
            return candidate
    return None


def run_program(arguments):
    """Run the program and return its output and messages. Raise RuntimeError with its message if it fails."""
    found = program()
    if not found:
        raise RuntimeError("The program pathwarp was not found. Run `pathwarp install gimp` to install it beside this plug-in.")
    flags = getattr(subprocess, "CREATE_NO_WINDOW", 0)
    done = subprocess.run([found, *arguments], stdin=subprocess.DEVNULL, capture_output=True, creationflags=flags)
    if done.returncode not in (0, 1):
        raise RuntimeError(done.stderr.decode("utf-8", "replace").strip() or "pathwarp failed")
    return done.stdout, done.stderr.decode("utf-8", "replace").strip()


def known():
    """Return the deformations that the installed program supports."""
    try:
        listed = run_program(["list"])[0].decode("utf-8", "replace")
    except (RuntimeError, OSError):
        return list(DEFORMATIONS)
    words = {line.split()[0] for line in listed.splitlines() if line.startswith("  ") and line.split()}
    return [name for name in DEFORMATIONS if name in words]


def point_list(path):
    """Return a path with its exact points as JSON data."""
    strokes = []
    for stroke in path.get_strokes():
        kind, points, closed = path.stroke_get_points(stroke)
        strokes.append({"type": int(kind), "closed": bool(closed), "num_points": len(points), "controlpoints": list(points)})
    return {"name": path.get_name(), "visible": bool(path.get_visible()), "strokes": strokes}


def named(image, name):
    """Return the path of this name."""
    for path in image.get_paths():
        if path.get_name() == name:
            return path
    raise RuntimeError("This image has no path named “%s”." % name)


def without(file, text):
    """Remove the name of a temporary file from a message."""
    return text.replace(file + "#", "").replace(file + ": ", "")


def deform(image, deformation, path, values):
    """Deform `path`, add the result to the image as a new path, and return it."""
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
        # A guide may also be the input: the program looks up all paths by name in one file.
        data = {"width": image.get_width(), "height": image.get_height(), "paths": [point_list(p) for p in used.values()]}
        with open(source, "w", encoding="utf-8") as file:
            json.dump(data, file)
        try:
            messages = run_program(arguments + [source + "#" + path.get_name(), "-o", result])[1]
        except RuntimeError as e:
            raise RuntimeError(without(source, str(e))) from None
        if messages:
            Gimp.message(without(source, messages))
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
    """Show the dialog. Return True if the user confirms it."""
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
                    # Keep a value that is not listed, such as a file.
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
    """Convert a stored value to percent. Scripts may pass a plain number instead of a percentage."""
    for candidate in (text, default):
        try:
            return float(candidate[:-1]) if candidate.endswith("%") else 100 * float(candidate)
        except ValueError:
            pass
    return 0


def guesses(image, config, arguments):
    """Return the names to choose from and the best guess for every argument that is a path."""
    names = [path.get_name() for path in image.get_paths()]
    selected = [path.get_name() for path in image.get_selected_paths()]
    roles = [name for name, kind, *_ in arguments if kind == "path"]
    found = {}
    for role in roles:
        stored = config.get_property(role)
        # Users of the original shaper plug-in name their paths after their roles.
        found[role] = stored if stored in names else next((n for n in names if n.lower() == role), "")
    # Prefer a path that is not a guide as input.
    free = [n for n in selected + names if n not in found.values() and n.lower() not in roles]
    path = (free or selected or names)[0]
    for role in REQUIRED.intersection(roles):
        found[role] = found[role] or next((n for n in selected + names if n != path), path)
    return {"path": (names, path)} | {r: (names if r in REQUIRED else [""] + names, n) for r, n in found.items()}


def choices(deformation, argument):
    """Return the values of a "choice" according to the program; empty if it cannot be run."""
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
        procedure.set_documentation(blurb, "Choose paths by name. The result is a new path.", name)
        procedure.set_attribution("The pathwarp authors", "The pathwarp authors", "2026")
        both = GObject.ParamFlags.READWRITE
        for argument, kind, label, tip, default in [PATH] + arguments:
            if kind == "flag":
                procedure.add_boolean_argument(argument, label, tip, default, both)
            else:
                procedure.add_string_argument(argument, label, tip, default, both)
        procedure.add_string_argument("options", "_Options", "Additional command-line options", "", both)
        procedure.add_path_return_value("result", "Result", "The new path", False, both)
        return procedure


Gimp.main(Pathwarp.__gtype__, sys.argv)
