"""A bed run in ParaView: soil balls by colour, contacts as thick as their force, drum and frame, phase and
forces as text.

    pvpython postprocess/paraview/bed.py results/bed/B/vtk --png bed.png --time 0.02
    pvpython postprocess/paraview/bed.py results/bed/B/vtk --animation bed.avi --cycle 1 --colour pressure
    pvpython postprocess/paraview/bed.py results/drive/B/vtk --animation drive.png --follow 2

The folder is the one that ./drumlin vtk has written. Without a screen, run pvpython by xvfb-run. In ParaView
itself: open balls.pvd of that folder, then Macros > Import new macro (once) and this file; it takes the folder
of the file that is selected in the pipeline.
Needs ParaView 5.10 or newer.
"""

import argparse
import atexit
import json
import math
import os
import shutil
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from xml.sax.saxutils import quoteattr

import paraview.simple as pv

# --colour: array, component, factor of the unit shown, title
COLOURS = {
    "speed": ("velocity", "Magnitude", 1.0, "speed of the soil [m/s]"),
    "pressure": ("pressure", "", 1e-3, "pressure in a ball [kPa]"),
    "coordination": ("coordination", "", 1.0, "contacts of a ball"),
    "spin": ("angular_velocity", "Magnitude", 1.0, "angular velocity [rad/s]"),
}
LOWEST, DRUM, FRAME, SECOND = 1, 2, 3, 4  # types of balls; further layers are 5, 6, ...
SAND = (0.00, 0.97, 0.95, 0.89), (0.35, 0.99, 0.84, 0.50), (0.70, 0.94, 0.55, 0.20), (1.00, 0.72, 0.23, 0.08)
STEEL, INK = [0.10, 0.33, 0.60], [0.08, 0.08, 0.16]  # of drum and frame, of contacts and text
# Of the edges of the balls, in a bed of layers; used again from the fifth layer on
LAYERS = [0.45, 0.45, 0.45], [0.00, 0.55, 0.40], [0.70, 0.30, 0.60], [0.25, 0.65, 0.90]
# Above and to the right of the bed and around it, in heights of the picture.
TEXT_BAND, BAR_BAND, MARGIN = 0.08, 0.27, 0.02
SHADER = """//VTK::Color::Impl
float square = dot(offsetVCVSOutput.xy, offsetVCVSOutput.xy);
if (square > 1.0) { discard; }
%s
float shade = %s;
ambientColor *= shade;
diffuseColor *= shade;
"""
ROUND, PLAIN = "0.45 + 0.55 * sqrt(1.0 - square)", "1.0"  # shades of balls, and of what is clear
# Discs with a darker edge (ParaView's own has a black one, which looks like a contact), balls, and what is
# clear.
DISC, BALL, CLEAR = (SHADER % ("", shade) for shade in ("square > 0.8 ? 0.7 : 1.0", ROUND, PLAIN))
EDGE = "if (square > 0.64) { ambientColor = vec3(0.0); diffuseColor = vec3(%g, %g, %g); }"
LEAST_FORCE = 0.05  # of the one drawn widest: contacts below it are left out
# In three dimensions the soil in front of this share of the depth is taken away, so that contacts are seen.
CUT_AT = 0.5


class Fault(Exception):
    """What the user can mend. (To leave by sys.exit would take ParaView along.)"""


class Scene:
    """The values of all steps together that ./drumlin vtk writes to scene.json."""

    def __init__(self, folder):
        file = os.path.join(folder, "scene.json")
        if not os.path.isfile(os.path.join(folder, "balls.pvd")) or not os.path.isfile(file):
            raise Fault("DIR is '%s'; allowed: a folder with balls.pvd and scene.json, as ./drumlin vtk writes it"
                        % folder)
        try:
            with open(file, encoding="utf-8") as text:
                read = json.load(text)
            self.flat = read["dimension"] == 2
            self.bounds = read["bounds"]
            self.mean_diameter = float(read["mean_diameter"])
            self.period = read.get("period")
            self.forces = [(float(time), float(force)) for time, force in read.get("force_on_drum", [])]
            self.sizes = {name: float(size["quantile_99"]) or float(size["largest"])
                          for name, size in read["sizes"].items()}
            if "coordination" in self.sizes:  # whole numbers: a scale has room for all
                self.sizes["coordination"] = float(read["sizes"]["coordination"]["largest"])
            if self.flat:  # discs, whatever their radius
                self.bounds[0][2] = self.bounds[1][2] = 0.0
        except (ValueError, KeyError, TypeError, IndexError) as fault:
            raise Fault("'%s' is damaged (%s); allowed: the one that ./drumlin vtk writes" % (file, fault))
        self.cut = self.bounds[0][2] + CUT_AT * (self.bounds[1][2] - self.bounds[0][2])


def wrong_with(file):
    """What is wrong with a file of VTK; nothing if it has its end."""
    if not os.path.isfile(file):
        return "is missing"
    with open(file, "rb") as content:
        content.seek(max(0, os.path.getsize(file) - 64))
        return "" if b"</VTKFile>" in content.read() else "is cut short"


def listed(file):
    """Time and file of each step that a collection lists."""
    try:
        steps = [(float(entry.get("timestep")), os.path.join(os.path.dirname(os.path.abspath(file)), entry.get("file")))
                 for entry in ElementTree.parse(file).getroot().iter("DataSet")]
    except (OSError, ElementTree.ParseError, TypeError, ValueError) as fault:
        raise Fault("'%s' is no whole list of steps (%s); allowed: the one that ./drumlin vtk writes" % (file, fault))
    if not steps:
        raise Fault("'%s' lists no steps" % file)
    return steps


def whole_steps(folder, names):
    """The files of each collection by time: of the steps whose files are all there and whole. Says which are left
    out."""
    lists = {name: dict(listed(os.path.join(folder, name + ".pvd"))) for name in names}
    times, files = [], {name: [] for name in names}
    for time in sorted(lists["balls"]):
        faults = ["%s %s" % (os.path.basename(lists[name][time]), wrong_with(lists[name][time])) if time in lists[name]
                  else "%s.pvd has no such step" % name
                  for name in names if time not in lists[name] or wrong_with(lists[name][time])]
        if faults:
            print("step at %g s left out: %s" % (time, ", ".join(faults)))
            continue
        times.append(time)
        for name in names:
            files[name].append(lists[name][time])
    if not times:
        raise Fault("DIR is '%s': no step has all its files (%s)" % (folder, ", ".join(names)))
    return times, files


def time_of_picture(scene, times, wanted):
    """The step next to the wanted time; without one that with the largest force of the soil on the drum, of those
    with the same the first; the last one where no force is known."""
    if wanted is None:
        near = {"%.9g" % time: time for time in times}
        forces = [(force, near["%.9g" % time]) for time, force in scene.forces if "%.9g" % time in near]
        return max(forces, key=lambda found: (found[0], -found[1]))[1] if forces else times[-1]
    return min(times, key=lambda time: abs(time - wanted))


def reader(folder, name, times, files):
    """A reader of these steps. ParaView's own does not get over a file that is missing, so it is given a list without
    it."""
    file = os.path.join(folder, name + ".pvd")
    if len(times) == len(listed(file)):
        return pv.PVDReader(registrationName=name, FileName=file)
    folder = tempfile.mkdtemp(prefix="drumlin-paraview-")
    atexit.register(shutil.rmtree, folder, True)
    file = os.path.join(folder, name + ".pvd")
    with open(file, "w", encoding="utf-8", errors="surrogateescape") as text:
        text.write('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n')
        for time, data in zip(times, files):
            text.write("<DataSet timestep=%s file=%s/>\n" % (quoteattr(repr(time)), quoteattr(data)))
        text.write("</Collection>\n</VTKFile>\n")
    return pv.PVDReader(registrationName=name, FileName=file)


def of_type(balls, kind, name):
    """The balls of one type."""
    part = pv.Threshold(registrationName=name, Input=balls)
    part.Scalars = ["POINTS", "type"]
    part.LowerThreshold = part.UpperThreshold = kind
    part.ThresholdMethod = "Between"
    return part


def round_up(value):
    """The next round number, for the end of a scale."""
    unit = 10.0 ** math.floor(math.log10(value))
    return next(step * unit for step in (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10) if step * unit >= value * (1 - 1e-9))


def behind_cut(data, scene, name, kept_behind):
    """In three dimensions, what lies behind the cut, or before it."""
    if scene.flat:
        return data
    part = pv.Clip(registrationName=name, Input=data)
    part.ClipType = "Plane"
    part.ClipType.Origin, part.ClipType.Normal = [0.0, 0.0, scene.cut], [0.0, 0.0, 1.0]
    part.Invert = 1 if kept_behind else 0
    return part


def show_balls(part, view, shader):
    """Balls to scale, drawn as one point each: a hundred times quicker than spheres of triangles."""
    shown = pv.Show(part, view)
    shown.SetRepresentationType("Point Gaussian")
    shown.ShaderPreset, shown.CustomShader, shown.CustomTriangleScale = "Custom", shader, 2
    shown.ScaleByArray = 1
    shown.SetScaleArray = ["POINTS", "radius"]
    shown.UseScaleFunction = 0
    shown.GaussianRadius = 1.0
    return shown


def paint(shown, colour):
    """One colour for all of it, without shade."""
    shown.ColorArrayName = ["POINTS", ""]
    shown.DiffuseColor = shown.AmbientColor = colour
    shown.Ambient, shown.Diffuse, shown.Specular = 1.0, 0.0, 0.0


def write_text(source, view, size, place, justification="Left"):
    """Text at a place of the window; \\n begins a line."""
    shown = pv.Show(source, view)
    shown.WindowLocation, shown.Position = "Any Location", place
    shown.Color, shown.FontSize, shown.Justification = INK, size, justification
    return shown


def layer_shaders(scene, view, font, layers):
    """Shaders that draw the edges of the balls in the colours of their layers; the legend of these, the highest layer
    on top."""
    texts = [("ball edges:", INK)] + [("layer %d" % (n + 1), LAYERS[n % len(LAYERS)]) for n in reversed(range(layers))]
    for line, (text, colour) in enumerate(texts):
        name = pv.Text(registrationName=text, Text=text)
        shown = write_text(name, view, font, [1.0 - 0.8 * scene.bar_share, 0.96 - 1.2 * line * scene.line])
        shown.Color, shown.Bold = colour, line > 0
    return [SHADER % (EDGE % tuple(colour), PLAIN if scene.flat else ROUND) for _, colour in reversed(texts[1:])]


def show_soil(balls, scene, colour, most, view, font):
    array, component, factor, title = COLOURS[colour]
    if array not in balls.PointData.keys():
        raise Fault("--colour is '%s': the balls have no '%s', for there were no dumps of contacts" % (colour, array))
    if most is None:
        most = factor * scene.sizes.get(array, 0.0)
        most = 1.0 if most <= 0.0 else most if colour == "coordination" else round_up(most)
    kinds = [LOWEST] + list(range(SECOND, int(balls.PointData["type"].GetRange()[1]) + 1))  # a layer each
    soil = [behind_cut(of_type(balls, kind, "soil %d" % n), scene, "soil %d behind the cut" % n, True)
            for n, kind in enumerate(kinds, 1)]
    shaders = layer_shaders(scene, view, font, len(kinds)) if len(kinds) > 1 else [DISC if scene.flat else BALL]
    shown_array = array if factor == 1.0 else array + "_shown"
    for part, shader in zip(soil, shaders):
        if factor != 1.0:
            part = pv.Calculator(registrationName="soil in kPa", Input=part)
            part.Function, part.ResultArrayName = "%g*%s" % (factor, array), shown_array
        shown = show_balls(part, view, shader)
        pv.ColorBy(shown, ("POINTS", shown_array, component) if component else ("POINTS", shown_array))
    scale = pv.GetColorTransferFunction(shown_array)
    scale.ColorSpace = "RGB"
    scale.RGBPoints = [number for point in SAND for number in (most * point[0], *point[1:])]
    bar = pv.GetScalarBar(scale, view)
    if colour == "coordination":  # whole numbers: a step of colour for each
        most = math.ceil(most)
        scale.RescaleTransferFunction(-0.5, most + 0.5)
        scale.NumberOfTableValues = most + 1
        bar.UseCustomLabels, bar.CustomLabels = 1, [float(n) for n in range(most + 1)]
    bar.AddRangeLabels = 0  # the range ends at a round number
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = INK
    bar.TitleFontSize = bar.LabelFontSize = font
    bar.HorizontalTitle = 1
    bar.WindowLocation, bar.Position = "Any Location", [1.0 - 0.8 * scene.bar_share, 0.40]
    bar.ScalarBarLength, bar.ScalarBarThickness = 0.40, font
    shown.SetScalarBarVisibility(view, True)


def show_roller(balls, scene, view, font):
    """In two dimensions drum and frame are circles, behind the contacts; in three they are clear, the frame is one ball
    on top."""
    for kind, name in ((DRUM, "drum"), (FRAME, "frame")):
        part = of_type(balls, kind, name)
        part.UpdatePipeline()
        if part.GetDataInformation().GetNumberOfPoints() == 0:
            continue
        if scene.flat:
            for inner, opacity in ((0.0, 0.12), (0.488, 1.0)):
                disc = pv.Disk(registrationName="disc", InnerRadius=inner, OuterRadius=0.5,
                               CircumferentialResolution=120)
                circle = pv.GlyphWithCustomSource(registrationName=name + " outline", Input=part, GlyphSource=disc)
                circle.ScaleArray, circle.ScaleFactor = ["POINTS", "diameter"], 1.0
                circle.OrientationArray, circle.GlyphMode = ["POINTS", "No orientation array"], "All Points"
                shown = pv.Show(circle, view)
                pv.Hide(disc, view)
                paint(shown, STEEL)
                shown.Opacity = opacity
            bounds, height = circle.GetDataInformation().GetBounds(), 0.62
        else:
            shown = show_balls(part, view, CLEAR)
            paint(shown, STEEL)
            shown.Opacity = 0.06 if kind == DRUM else 0.5  # a drum is some hundred balls, one behind the other
            bounds, height = part.GetDataInformation().GetBounds(), 0.5
        label = pv.Show(pv.Text(registrationName=name + " label", Text=name), view)
        label.TextPropMode = "Billboard 3D Text"
        half = 0.25 * len(name) * font * scene.pixel  # the place is that of its left end
        if bounds[1] - bounds[0] < 4.0 * half:  # next to a ball that is too small
            half = -1.5 * font * scene.pixel
        label.BillboardPosition = [0.5 * (bounds[0] + bounds[1]) - half, bounds[2] + height * (bounds[3] - bounds[2]),
                                   0.5 * (bounds[4] + bounds[5])]
        label.Color, label.FontSize = STEEL, font


def show_contacts(contacts, scene, view):
    """Tubes as thick as the normal force: at the quantile, and above it, half as thick as a mean ball."""
    full = scene.sizes.get("normal_force", 0.0)
    if full <= 0.0:
        return
    if scene.flat:  # in front of balls and drum
        part = pv.Transform(registrationName="contacts in front", Input=contacts)
        part.Transform.Translate = [0.0, 0.0, scene.mean_diameter]
    else:
        part = behind_cut(contacts, scene, "contacts before the cut", False)
    points = pv.CellDatatoPointData(registrationName="contacts at points", Input=part)
    strong = pv.Threshold(registrationName="contacts of some force", Input=points)  # the others would be a haze
    strong.Scalars = ["POINTS", "normal_force"]
    strong.LowerThreshold, strong.UpperThreshold = -LEAST_FORCE * full, LEAST_FORCE * full
    strong.ThresholdMethod, strong.Invert = "Between", 1
    lines = pv.ExtractSurface(registrationName="lines", Input=strong)  # as Tube wants them
    thickness = pv.Calculator(registrationName="thickness", Input=lines)
    thickness.ResultArrayName = "thickness"
    widest = 0.25 * scene.mean_diameter  # a line narrower than a pixel would have gaps
    thickness.Function = "max(%.17g*min(abs(normal_force)/%.17g, 1), %.17g)" % (
        widest, full, min(widest, 0.45 * scene.pixel))
    tubes = pv.Tube(registrationName="force chains", Input=thickness)
    tubes.Scalars = ["POINTS", "thickness"]
    tubes.VaryRadius = "By Absolute Scalar"
    tubes.NumberofSides = 6
    tubes.Capping = 0
    shown = pv.Show(tubes, view)
    paint(shown, INK)
    if not scene.flat:
        shown.Ambient, shown.Diffuse = 0.4, 0.6


def look(view, scene, size):
    """Parallel, and all of the bed as large as the window has room for it, below the text and left of the colour
    bar."""
    towards = (0.0, 0.0, 1.0) if scene.flat else (0.32, 0.25, 0.91)  # the viewer, from the bed; y is up
    length = math.sqrt(sum(part * part for part in towards))
    back = [part / length for part in towards]
    flat = math.hypot(back[0], back[2])
    right = [back[2] / flat, 0.0, -back[0] / flat]
    up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2],
          back[0] * right[1] - back[1] * right[0]]
    low, high = scene.bounds
    corners = [[pair[bit] for pair, bit in zip(zip(low, high), bits)] for bits in
               [(i & 1, i >> 1 & 1, i >> 2 & 1) for i in range(8)]]

    def extent(axis):
        along = [sum(a * b for a, b in zip(corner, axis)) for corner in corners]
        return min(along), max(along)

    (left_most, right_most), (lowest, highest) = extent(right), extent(up)
    wide, high_ = right_most - left_most, highest - lowest
    if size is None:  # as wide as the bed needs
        height = 1080
        width = height * (wide / high_ * (1.0 - TEXT_BAND - 2 * MARGIN) + BAR_BAND + 2 * MARGIN)
        if width > 1920:
            height, width = max(400, int(height * 1920 / width)), 1920
        size = [2 * int(width / 2), 2 * int(height / 2)]
    room_wide, room_high = size[0] / size[1] - BAR_BAND - 2 * MARGIN, 1.0 - TEXT_BAND - 2 * MARGIN
    per_height = max(wide / max(room_wide, 0.1), high_ / room_high)  # metres in the height of the picture
    across = 0.5 * (left_most + right_most) + 0.5 * BAR_BAND * per_height
    above = 0.5 * (lowest + highest) + 0.5 * TEXT_BAND * per_height
    middle = [0.5 * (a + b) for a, b in zip(low, high)]
    deep = sum(a * b for a, b in zip(middle, back))
    focus = [across * r + above * u + deep * b for r, u, b in zip(right, up, back)]
    far = 4.0 * max(wide, high_)
    view.InteractionMode = "2D" if scene.flat else "3D"
    view.CameraParallelProjection = 1
    view.CameraFocalPoint, view.CameraViewUp = focus, up
    view.CameraPosition = [f + far * b for f, b in zip(focus, back)]
    view.CameraParallelScale = 0.5 * per_height
    scene.pixel = per_height / size[1]
    return size


def show_text(balls, scene, contacts, view, font):
    known = balls.FieldData.keys()
    unit = "kN/m" if scene.flat else "kN"  # per metre along the axis of the drum
    parts = [("t = %.4f s", "t_value", None), ("     cycle %d, phase %.0f deg", "cycle[0], phase[0]", "phase"),
             ("\\nforce on the drum: by the soil %.1f " + unit + " up", "F_contact[0]/1e3", "F_contact"),
             (", by the exciter %.1f " + unit + " %s",
              "abs(F_excitation[0])/1e3, 'down' if F_excitation[0] >= 0 else 'up'", "F_excitation")]
    parts = [part for part in parts if part[2] is None or part[2] in known]
    caption = pv.PythonAnnotation(registrationName="caption", Input=balls)
    caption.ArrayAssociation = "Field Data"
    caption.Expression = '"%s" %% (%s,)' % ("".join(part[0] for part in parts), ", ".join(part[1] for part in parts))
    write_text(caption, view, font, [0.02, 0.935])
    full = scene.sizes.get("normal_force", 0.0)
    if contacts and full > 0.0:
        lines = ("lines: contacts,\nas wide as their\nforce; widest:\n%.3g {0} or more,\nnone below\n%.2g {0}"
                 .format(unit))
        if not scene.flat:
            lines += ";\nthe soil in front\nis not drawn"
        key = pv.Text(registrationName="width of the lines", Text=lines % (1e-3 * full, 1e-3 * LEAST_FORCE * full))
        write_text(key, view, font, [1.0 - 0.8 * scene.bar_share, 0.27 if scene.flat else 0.16])


def show(folder, colour="speed", contacts=True, most=None, cycle=None, size=None, follow=None):
    """Shows the run in the active view, or in a new one; returns view, its size, the times, the scene and the
    balls."""
    scene = Scene(folder)
    contacts = contacts and os.path.isfile(os.path.join(folder, "contacts.pvd"))
    times, files = whole_steps(folder, ["balls", "contacts"] if contacts else ["balls"])
    if cycle is not None:
        if scene.period is None:
            raise Fault("--cycle is '%d': the run's excitation is not known; allowed: no --cycle" % cycle)
        of_cycle = [n for n, time in enumerate(times) if cycle - 1 - 1e-9 <= time / scene.period <= cycle + 1e-9]
        if not of_cycle:
            raise Fault("--cycle is '%d': no steps; allowed: 1 to %d"
                        % (cycle, math.ceil(times[-1] / scene.period - 1e-9)))
        times = [times[n] for n in of_cycle]
        files = {name: [files[name][n] for n in of_cycle] for name in files}
    view = pv.GetActiveViewOrCreate("RenderView")
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 0
    balls = reader(folder, "balls", times, files["balls"])
    balls.UpdatePipeline(times[0])
    if balls.GetDataInformation().GetNumberOfPoints() == 0:
        raise Fault("'%s' cannot be read; allowed: a file that ./drumlin vtk has written" % files["balls"][0])
    if follow is not None:
        scene.seen_from = place_of_drum(balls, times[0])
        scene.bounds[0][0], scene.bounds[1][0] = scene.seen_from - 0.5 * follow, scene.seen_from + 0.5 * follow
    size = look(view, scene, size)
    scene.bar_share = BAR_BAND * size[1] / size[0]
    font = max(12, size[1] // 54)
    scene.line = font / size[1]  # height of a line of text
    show_soil(balls, scene, colour, most, view, font)
    show_roller(balls, scene, view, font)
    if contacts:
        show_contacts(reader(folder, "contacts", times, files["contacts"]), scene, view)
    show_text(balls, scene, contacts, view, font)
    return view, size, times, scene, balls


def place_of_drum(balls, time):
    """Along the way."""
    drum = of_type(balls, DRUM, "drum at a time")
    drum.UpdatePipeline(time)
    low, high = drum.GetDataInformation().GetBounds()[:2]
    pv.Delete(drum)
    return 0.5 * (low + high)


def follow_drum(view, scene, balls):
    """Moves camera and names along the way, to where the drum is at the time of the view."""
    by = place_of_drum(balls, view.ViewTime) - scene.seen_from
    scene.seen_from += by
    view.CameraPosition = [view.CameraPosition[0] + by, *view.CameraPosition[1:]]
    view.CameraFocalPoint = [view.CameraFocalPoint[0] + by, *view.CameraFocalPoint[1:]]
    for name in ("drum label", "frame label"):
        text = pv.FindSource(name)
        if text is not None:
            shown = pv.GetDisplayProperties(text, view)
            shown.BillboardPosition = [shown.BillboardPosition[0] + by, *shown.BillboardPosition[1:]]


def selected_folder():
    """The folder of the file that is selected in ParaView's pipeline."""
    source = pv.GetActiveSource()
    name = getattr(source, "FileName", None) if source is not None else None
    if not name:
        raise Fault("nothing is selected; allowed: balls.pvd, opened and selected in the pipeline")
    return os.path.dirname(os.path.abspath(str(name)))


class Parser(argparse.ArgumentParser):
    """With faults of one line."""

    def error(self, message):
        raise Fault(message)


def above_zero(kind):
    def read(text):
        value = kind(text)
        if not 0 < value < math.inf:
            raise ValueError
        return value
    read.__name__ = "number > 0" if kind is float else "whole number > 0"
    return read


def main(words):
    parser = Parser(prog="paraview_bed", description=__doc__.split("\n")[0])
    parser.add_argument("folder", metavar="DIR", help="the folder that ./drumlin vtk has written, with balls.pvd")
    parser.add_argument("--colour", choices=sorted(COLOURS), default="speed", help="of the soil balls (default: speed)")
    parser.add_argument("--max", type=above_zero(float), metavar="VALUE",
                        help="upper end of the colours, in the unit shown "
                             "(default: what 99 %% of the soil balls never exceed)")
    parser.add_argument("--time", type=float, metavar="S",
                        help="of the picture [s]; the step next to it is shown "
                             "(default: that with the largest force of the soil on the drum)")
    parser.add_argument("--cycle", type=above_zero(int), metavar="N",
                        help="only this cycle of the excitation, from 1 (default: all)")
    parser.add_argument("--png", metavar="FILE", help="a picture")
    parser.add_argument("--animation", metavar="FILE", help="all steps: .avi or .ogv, or .png for a numbered series")
    parser.add_argument("--follow", type=above_zero(float), metavar="M",
                        help="this length of the way around the drum [m], wherever it drives (default: the whole bed)")
    parser.add_argument("--no-contacts", action="store_true", help="balls alone")
    parser.add_argument("--size", type=above_zero(int), nargs=2, metavar=("W", "H"),
                        help="pixels (default: 1080 high, as wide as the bed needs)")
    given = parser.parse_args(words)
    if not given.png and not given.animation:
        raise Fault("nothing to do; allowed: --png FILE, --animation FILE")
    for option, file, endings in (("--png", given.png, (".png",)),
                                  ("--animation", given.animation, (".avi", ".ogv", ".png"))):
        if file and not file.endswith(endings):
            raise Fault("%s is '%s'; allowed: a file ending in %s" % (option, file, ", ".join(endings)))
        if file and not os.access(os.path.dirname(os.path.abspath(file)), os.W_OK):  # ParaView itself would continue
            raise Fault("%s is '%s'; allowed: a file in a folder that can be written to" % (option, file))
    if given.follow and given.animation and not given.animation.endswith(".png"):
        raise Fault("--animation is '%s'; allowed: with --follow a file ending in .png, for a numbered series"
                    % given.animation)
    view, size, times, scene, balls = show(given.folder, given.colour, not given.no_contacts, given.max,
                                           given.cycle, given.size, given.follow)
    view.ViewSize = size
    animation = pv.GetAnimationScene()
    animation.UpdateAnimationUsingDataTimeSteps()  # as ParaView with windows does by itself
    animation.AnimationTime = view.ViewTime = time_of_picture(scene, times, given.time)
    if given.follow:
        follow_drum(view, scene, balls)
    if given.png:
        pv.SaveScreenshot(given.png, view, ImageResolution=size, CompressionLevel="9")
        print("%s: t = %.6g s" % (given.png, view.ViewTime))
    if given.animation and given.follow:
        stem, ending = os.path.splitext(given.animation)
        for number, time in enumerate(times):
            animation.AnimationTime = view.ViewTime = time
            follow_drum(view, scene, balls)
            pv.SaveScreenshot("%s.%04d%s" % (stem, number, ending), view, ImageResolution=size)
        print("%s: %d pictures" % (given.animation, len(times)))
    elif given.animation:
        pv.SaveAnimation(given.animation, view, ImageResolution=size, FrameRate=25, FrameWindow=[0, len(times) - 1])
        print(given.animation)


if not sys.argv or not sys.argv[0]:  # a macro: ParaView names no script
    show(selected_folder(), size=list(pv.GetActiveViewOrCreate("RenderView").ViewSize))
    pv.Render()
elif __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except Fault as fault:
        sys.exit("ERROR: paraview_bed: %s" % fault)
