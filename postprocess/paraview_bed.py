"""A bed run in ParaView: balls to scale, contacts as tubes as thick as their force, drum and frame apart from the soil.

    pvpython postprocess/paraview_bed.py DIR/vtk --png bed.png --time 0.02
    pvpython postprocess/paraview_bed.py DIR/vtk --animation bed.avi --colour coordination

DIR/vtk holds the collections of ./drumlin vtk DIR. In ParaView itself: open DIR/vtk/balls.pvd, then Macros > Import new
macro (once) and this file; it takes the folder of the file that is selected in the pipeline. Without a screen, run pvpython
by xvfb-run. Needs ParaView 5.10 or newer.
"""

import argparse
import os
import sys

import paraview.simple as pv

COLOURS = {  # name: array, component, title
    "speed": ("velocity", "Magnitude", "speed [m/s]"),
    "coordination": ("coordination", "", "contacts of a ball"),
    "spin": ("angular_velocity", "Magnitude", "angular velocity [rad/s]"),
}
SOIL, DRUM, FRAME = 1, 2, 3


class Fault(Exception):
    """What the user can mend. (To leave by sys.exit would take ParaView along.)"""


def fail(message):
    raise Fault(message)


def collection(folder, name):
    """The reader of a collection, or None if there is none."""
    file = os.path.join(folder, name + ".pvd")
    return pv.PVDReader(registrationName=name, FileName=file) if os.path.isfile(file) else None


def of_type(balls, kind, name):
    """The balls of one type."""
    part = pv.Threshold(registrationName=name, Input=balls)
    part.Scalars = ["POINTS", "type"]
    part.LowerThreshold = part.UpperThreshold = kind
    part.ThresholdMethod = "Between"
    return part


def spheres(part, name, resolution):
    """A sphere of its diameter for each ball, whatever their number."""
    glyph = pv.Glyph(registrationName=name, Input=part, GlyphType="Sphere")
    glyph.ScaleArray = ["POINTS", "diameter"]
    glyph.ScaleFactor = 1.0
    glyph.OrientationArray = ["POINTS", "No orientation array"]
    glyph.GlyphMode = "All Points"
    glyph.GlyphType.ThetaResolution = glyph.GlyphType.PhiResolution = resolution
    return glyph


def largest(source, times, array, association):
    """The largest value of an array over all times."""
    most = 0.0
    for time in times:
        source.UpdatePipeline(time)
        data = source.PointData if association == "POINTS" else source.CellData
        if array in data.keys():
            component = -1 if data[array].GetNumberOfComponents() > 1 else 0
            most = max(most, data[array].GetRange(component)[1])
    return most


def show_soil(balls, times, colour, view):
    array, component, title = COLOURS[colour]
    balls.UpdatePipeline(times[0])
    if array not in balls.PointData.keys():
        fail("the balls have no '%s': there were no dumps of contacts" % array)
    soil = of_type(balls, SOIL, "soil")
    most = largest(soil, times, array, "POINTS")
    shown = pv.Show(spheres(soil, "soil balls", 16), view)
    pv.ColorBy(shown, ("POINTS", array, component) if component else ("POINTS", array))
    scale = pv.GetColorTransferFunction(array)
    scale.RescaleTransferFunction(0.0, most or 1.0)  # the same at all times
    bar = pv.GetScalarBar(scale, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    shown.SetScalarBarVisibility(view, True)
    return soil


def show_roller(balls, view):
    for kind, name, colour in ((DRUM, "drum", [0.90, 0.45, 0.10]), (FRAME, "frame", [0.55, 0.55, 0.60])):
        shown = pv.Show(spheres(of_type(balls, kind, name), name + " ball", 64), view)
        shown.ColorArrayName = ["POINTS", ""]
        shown.DiffuseColor = shown.AmbientColor = colour
        shown.Opacity = 0.8


def show_contacts(contacts, times, radius, flat, view):
    """Tubes whose radius is the magnitude of the normal force, the largest of all times as thick as half a ball."""
    most = largest(contacts, times, "normal_force", "CELLS")
    if most <= 0.0:
        return
    points = pv.CellDatatoPointData(registrationName="contacts at points", Input=contacts)
    thickness = pv.Calculator(registrationName="thickness", Input=points)
    thickness.ResultArrayName = "thickness"
    thickness.Function = "%.17g*abs(normal_force)" % (0.5 * radius / most)
    tubes = pv.Tube(registrationName="force chains", Input=thickness)
    tubes.Scalars = ["POINTS", "thickness"]
    tubes.VaryRadius = "By Absolute Scalar"
    tubes.NumberofSides = 8
    shown = pv.Show(tubes, view)
    shown.ColorArrayName = ["POINTS", ""]
    shown.DiffuseColor = shown.AmbientColor = [0.10, 0.10, 0.10]
    if flat:  # in front of the balls, which are spheres
        shown.Position = [0.0, 0.0, 2.0 * radius]


def scene(folder, colour, contacts_wanted=True):
    """Shows the run in the active view, or in a new one; returns view and times."""
    balls = collection(folder, "balls")
    if balls is None:
        fail("'%s' has no balls.pvd; allowed: the folder that ./drumlin vtk has written" % folder)
    times = list(balls.TimestepValues) if hasattr(balls.TimestepValues, "__len__") else [balls.TimestepValues]
    view = pv.GetActiveViewOrCreate("RenderView")
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 0
    soil = show_soil(balls, times, colour, view)
    show_roller(balls, view)
    radius = largest(soil, times[:1], "radius", "POINTS")
    bounds = soil.GetDataInformation().GetBounds()
    flat = bounds[4] == bounds[5]
    contacts = collection(folder, "contacts") if contacts_wanted else None
    if contacts is not None:
        show_contacts(contacts, times, radius, flat, view)
    label = pv.AnnotateTimeFilter(registrationName="time", Input=balls)
    label.Format = "t = {time:.4f} s"
    pv.Show(label, view).Color = [0.0, 0.0, 0.0]
    if flat:
        view.InteractionMode = "2D"
        pv.ResetCamera(view)
    else:  # the vertical axis is z
        view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0, -1, 0], [0, 0, 0], [0, 0, 1]
        pv.ResetCamera(view)
    return view, times


def selected_folder():
    """The folder of the file that is selected in ParaView's pipeline."""
    source = pv.GetActiveSource()
    name = getattr(source, "FileName", None) if source is not None else None
    if not name:
        fail("open DIR/vtk/balls.pvd and select it in the pipeline first")
    return os.path.dirname(os.path.abspath(str(name)))


def main(words):
    parser = argparse.ArgumentParser(prog="paraview_bed", description=__doc__.split("\n")[0])
    parser.add_argument("folder", metavar="DIR", help="that of balls.pvd")
    parser.add_argument("--colour", choices=sorted(COLOURS), default="speed", help="of the soil balls (default: speed)")
    parser.add_argument("--time", type=float, help="of the picture [s]; the dump next to it is shown (default: the last)")
    parser.add_argument("--png", metavar="FILE", help="a picture")
    parser.add_argument("--animation", metavar="FILE", help="all times: .avi or .ogv, or .png for a numbered series")
    parser.add_argument("--no-contacts", action="store_true", help="balls alone")
    parser.add_argument("--size", type=int, nargs=2, default=[1600, 1000], metavar=("W", "H"), help="pixels")
    given = parser.parse_args(words)
    if not given.png and not given.animation:
        fail("nothing to do; allowed: --png FILE, --animation FILE")
    for file in (given.png, given.animation):  # ParaView itself would go on
        if file and not os.access(os.path.dirname(os.path.abspath(file)), os.W_OK):
            fail("'%s' cannot be written; allowed: a file in a folder that exists" % file)
    view, times = scene(given.folder, given.colour, not given.no_contacts)
    pv.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()  # as ParaView with windows does by itself
    view.ViewSize = given.size
    wanted = times[-1] if given.time is None else given.time
    pv.GetAnimationScene().AnimationTime = view.ViewTime = min(times, key=lambda time: abs(time - wanted))
    pv.ResetCamera(view)
    if given.png:
        pv.SaveScreenshot(given.png, view, ImageResolution=given.size)
        print(given.png)
    if given.animation:
        pv.SaveAnimation(given.animation, view, ImageResolution=given.size, FrameRate=25,
                         FrameWindow=[0, len(times) - 1])
        print(given.animation)


if not sys.argv or not sys.argv[0]:  # a macro: ParaView names no script
    scene(selected_folder(), "speed")
elif __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except Fault as fault:
        sys.exit("ERROR: paraview_bed: %s" % fault)
