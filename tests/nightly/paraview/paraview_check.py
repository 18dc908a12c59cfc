"""What ParaView reads of a bed run, against what the engine dumped, and the pictures of postprocess/paraview/bed.py.

    pvpython tests/nightly/paraview/paraview_check.py RUN [BED_PY]

RUN has dump/, vtk/, parameters.csv and bed.csv. The dumps are read here by a few lines of plain Python, which share
nothing with what wrote vtk/. Pictures go to the working folder; without BED_PY there are none. Ends with status 1 at
the first difference.
"""

import base64
import bisect
import glob
import math
import os
import re
import shutil
import struct
import subprocess
import sys

import paraview.simple as pv
from paraview import servermanager
from vtkmodules.vtkIOImage import vtkPNGReader

DRUM, FRAME = 2, 3
compared = 0


def check(true, what):
    global compared
    compared += 1
    if not true:
        raise SystemExit("ERROR: paraview_check: %s" % what)


def near(found, expected, what, tolerance=1e-12):
    check(abs(found - expected) <= tolerance * max(1e-30, abs(expected)),
          "%s is %r, expected %r" % (what, found, expected))


def near_range(data, name, values, what, component=-1):
    found = data[name].GetRange(0 if data[name].GetNumberOfComponents() == 1 else component)
    scale = max(abs(value) for value in values)
    for side, expected in zip(found, (min(values), max(values))):
        check(abs(side - expected) <= 1e-10 * scale, "%s: range of %s is %r, expected %r to %r" % (
            what, name, found, min(values), max(values)))


def text_dump(file):
    """Rows of a text dump as dictionaries."""
    with open(file) as text:
        lines = text.read().splitlines()
    head = next(n for n, line in enumerate(lines) if line.startswith(("ITEM: ATOMS", "ITEM: ENTRIES")))
    names = lines[head].split()[2:]
    return [dict(zip(names, map(float, line.split()))) for line in lines[head + 1:]]


def vtk_dump(file):
    """The same of LIGGGHTS's file of VTK, arrays as base64 after their length."""
    with open(file) as text:
        content = text.read()
    columns = {}
    for head, body in re.findall(r"<DataArray ([^>]*)>([^<]*)<", content):
        words = dict(re.findall(r'(\w+)="([^"]*)"', head))
        code = {"Int32": "i", "Int64": "q", "Float32": "f", "Float64": "d"}.get(words["type"])
        if code is None or words["format"] != "binary":
            continue
        data = base64.b64decode(body.split("InformationKey")[0].strip())
        length, = struct.unpack_from("<I", data)
        values = struct.unpack_from("<%d%s" % (length // struct.calcsize(code), code), data, 4)
        parts = int(words.get("NumberOfComponents", 1))
        if parts == 1:
            columns[words["Name"]] = values
        for axis in range(parts if parts == 3 else 0):
            columns[{"Points": "", "v": "v", "omega": "omega", "f": "f"}.get(words["Name"], words["Name"])
                    + "xyz"[axis]] = values[axis::3]
    count = len(columns["id"])
    return [{name: column[n] for name, column in columns.items() if len(column) == count} for n in range(count)]


def size(row, name):
    return math.sqrt(sum(row[name + axis] ** 2 for axis in "xyz"))


def contact_rows(file):
    rows = []
    for row in text_dump(file):
        value = [row["f_contacts[%d]" % n] for n in range(1, 10)]
        rows.append({"id1": int(value[0]), "id2": int(value[1]), "force": value[2:5], "overlap": value[8],
                     "normal": sum(f * n for f, n in zip(value[2:5], value[5:8]))})
    return rows


def dumped_balls(run, step):
    file = os.path.join(run, "dump", "balls_%d" % step)
    return vtk_dump(file + ".vtp") if os.path.exists(file + ".vtp") else text_dump(file + ".dump")


def dumped_contacts(run, step):
    return contact_rows(os.path.join(run, "dump", "contacts_%d.dump" % step))


def force_on_drum(balls, contacts):
    drum = {int(ball["id"]) for ball in balls if ball["type"] == DRUM}
    return math.fsum(contact["force"][1] * ((contact["id1"] in drum) - (contact["id2"] in drum))
                     for contact in contacts)


def parameters(run):
    with open(os.path.join(run, "parameters.csv")) as text:
        return dict(line.rstrip("\n").split(",", 1) for line in text)


def forces_by_time(run):
    with open(os.path.join(run, "bed.csv")) as text:
        names = text.readline().strip().split(",")
        rows = [line.split(",") for line in text]
    return [float(row[0]) for row in rows], [float(row[names.index("F_contact")]) for row in rows]


def check_step(run, step, time, readers, flat, history):
    what = "step %d" % step
    for reader in readers.values():
        reader.UpdatePipeline(time)
    balls, contacts = dumped_balls(run, step), dumped_contacts(run, step)
    points = readers["balls"]
    near(points.GetDataInformation().GetNumberOfPoints(), len(balls), what + ": number of points")
    for name, of in (("id", "id"), ("type", "type"), ("radius", "radius"), ("mass", "mass")):
        near_range(points.PointData, name, [ball[of] for ball in balls], what)
    near_range(points.PointData, "diameter", [2 * ball["radius"] for ball in balls], what)
    for name, of in (("velocity", "v"), ("angular_velocity", "omega"), ("force", "f")):
        near_range(points.PointData, name, [size(ball, of) for ball in balls], what)
        near_range(points.PointData, name, [ball[of + "y"] for ball in balls], what, 1)
    bounds = points.GetDataInformation().GetBounds()
    for n, axis in enumerate("xyz"):
        for side, found in zip((min, max), bounds[2 * n:2 * n + 2]):
            check(abs(found - side(ball[axis] for ball in balls)) < 1e-6, "%s: bounds %r" % (what, bounds))

    lines = readers["contacts"]
    near(lines.GetDataInformation().GetNumberOfCells(), len(contacts), what + ": number of contacts")
    near_range(lines.CellData, "normal_force", [contact["normal"] for contact in contacts], what)
    near_range(lines.CellData, "overlap", [contact["overlap"] for contact in contacts], what)
    near_range(lines.CellData, "force", [math.hypot(*contact["force"]) for contact in contacts], what)
    number, pressed = {int(b["id"]): 0 for b in balls}, {int(b["id"]): 0.0 for b in balls}
    by_id = {int(ball["id"]): ball for ball in balls}
    for contact in contacts:
        one, other = contact["id1"], contact["id2"]
        if other == 0:
            pressed[one] += contact["normal"] * (by_id[one]["radius"] - contact["overlap"])
            continue
        for ball in (one, other):
            number[ball] += 1
            pressed[ball] += contact["normal"] * (by_id[ball]["radius"] - contact["overlap"] / 2)
    for ball in pressed:
        r = by_id[ball]["radius"]
        pressed[ball] /= 2 * math.pi * r ** 2 if flat else 4 * math.pi * r ** 3
    near_range(points.PointData, "coordination", list(number.values()), what)
    near_range(points.PointData, "pressure", list(pressed.values()), what)
    shown = servermanager.Fetch(points).GetFieldData().GetArray("F_contact").GetTuple1(0)
    near(shown, force_on_drum(balls, contacts), what + ": force on the drum", 1e-9)
    row = bisect.bisect(history[0], time - 1e-9)
    if row < len(history[0]) and abs(history[0][row] - time) < 1e-9:
        # bed.csv has the velocities at the end of the step in its dashpots, a dump those that acted in it
        check(abs(shown - history[1][row]) < 1e-3 * max(history[1]),
              "%s: force on the drum is %r, in bed.csv %r" % (what, shown, history[1][row]))

    image = servermanager.Fetch(readers["fields"])
    volume = math.prod(image.GetSpacing()[:2 if flat else 3])
    density = image.GetCellData().GetArray("bulk_density")
    mass = volume * math.fsum(density.GetTuple1(n) for n in range(density.GetNumberOfTuples()))
    near(mass, math.fsum(ball["mass"] for ball in balls if ball["type"] not in (DRUM, FRAME)),
         what + ": mass of the soil in the fields", 1e-9)
    print("%s, t = %.6g s: %d balls, %d contacts, %d cells; speed up to %.4g m/s, normal force up to %.5g N, "
          "on the drum %.6g N" % (
        what, time, len(balls), len(contacts), density.GetNumberOfTuples(), max(size(ball, "v") for ball in balls),
        max(contact["normal"] for contact in contacts), shown))


def check_numbers(run):
    dt, flat = float(parameters(run)["timestep"]), parameters(run)["dimension"] == "2"
    steps = sorted(int(re.findall(r"_(\d+)\.dump$", name)[0])
                   for name in glob.glob(os.path.join(run, "dump", "contacts_*.dump")))
    readers = {name: pv.PVDReader(FileName=os.path.join(run, "vtk", name + ".pvd"))
               for name in ("balls", "contacts", "fields")}
    for name, reader in readers.items():
        times = list(reader.TimestepValues)
        check(len(times) == len(steps), "%s: %d times, expected %d" % (name, len(times), len(steps)))
        for time, step in zip(times, steps):
            near(time, step * dt, "%s: time of step %d" % (name, step))
    history = forces_by_time(run)
    for n in sorted({0, len(steps) // 4, len(steps) // 2, len(steps) - 1}):
        check_step(run, steps[n], steps[n] * dt, readers, flat, history)
    strongest = max(steps, key=lambda step: force_on_drum(dumped_balls(run, step), dumped_contacts(run, step)))
    return len(steps), steps[len(steps) // 4] * dt, strongest * dt


def pixels(file):
    reader = vtkPNGReader()
    reader.SetFileName(file)
    reader.Update()
    colours = reader.GetOutput().GetPointData().GetScalars()
    return [colours.GetTuple3(n) for n in range(0, colours.GetNumberOfTuples(), 7)]


def check_pictures(run, script, time, strongest):
    program = shutil.which("pvpython")
    vtk = os.path.join(run, "vtk")

    def draw(*words):
        done = subprocess.run([program, script, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=600)
        return done.returncode, done.stdout.decode(errors="replace")

    for colour in ("speed", "pressure", "coordination", "spin"):
        status, said = draw(vtk, "--colour", colour, "--time", repr(time), "--png", colour + ".png")
        check(status == 0 and "Traceback" not in said, "bed.py --colour %s: status %d: %s" % (colour, status, said))
        seen = pixels(colour + ".png")
        ink = sum(max(p) < 60 for p in seen) / len(seen)  # contacts and text
        steel = sum(p[2] > p[0] + 8 for p in seen) / len(seen)  # drum and frame, clear blue
        white = sum(min(p) > 250 for p in seen) / len(seen)
        print("%s.png: %.3f of it contacts and text, %.3f drum and frame, %.3f empty" % (colour, ink, steel, white))
        check(ink > 0.01 and steel > 0.02 and white < 0.7, "%s.png does not show the bed" % colour)
    status, said = draw(vtk, "--png", "strongest.png")
    check(status == 0 and "strongest.png: t = %.6g s" % strongest in said,
          "bed.py without --time shows not the largest force, at %.6g s: %s" % (strongest, said))
    copy = "damaged vtk & more"
    for name, damage, expected, says in (
            ("balls cut short", lambda names: cut(names[0]), 0, "is cut short"),
            ("contacts missing", lambda names: os.remove(names[0].replace("balls_", "contacts_")), 0, "is missing"),
            ("a list cut short", lambda names: cut(os.path.join(copy, "balls.pvd")), 1,
             "ERROR: paraview_bed: '%s/balls.pvd' is no whole list" % copy),
            ("no scene", lambda names: os.remove(os.path.join(copy, "scene.json")), 1,
             "ERROR: paraview_bed: DIR is '%s'" % copy),
            ("a scene cut short", lambda names: cut(os.path.join(copy, "scene.json")), 1, "scene.json' is damaged"),
            ("balls of rubbish", lambda names: [rubbish(name) for name in names], 1, "cannot be read; allowed")):
        shutil.copytree(vtk, copy)
        damage(sorted(glob.glob(os.path.join(copy, "balls_*.vtp"))))
        status, said = draw(copy, "--png", "damaged.png", "--size", "300", "300")
        check(status == expected and says in said and "Traceback" not in said,
              "%s: status %d: %s" % (name, status, said))
        shutil.rmtree(copy)
    for words, says in ((("nowhere", "--png", "a.png"), "DIR is 'nowhere'; allowed"),
                        ((vtk,), "nothing to do; allowed"),
                        ((vtk, "--png", "no/a.png"), "--png is 'no/a.png'; allowed"),
                        ((vtk, "--png", "a.jpg"), "--png is 'a.jpg'; allowed"),
                        ((vtk, "--png", "a.png", "--cycle", "99"), "--cycle is '99'"),
                        ((vtk, "--png", "a.png", "--max", "0"), "--max")):
        status, said = draw(*words)
        check(status == 1 and "ERROR: paraview_bed: " in said and says in said and "Traceback" not in said,
              "%r: status %d: %s" % (words, status, said))


def cut(file):
    os.truncate(file, os.path.getsize(file) // 2)


def rubbish(file):
    with open(file, "r+b") as content:
        content.seek(300)
        content.write(b"<<<")


if __name__ == "__main__":
    print("ParaView %s" % pv.GetParaViewVersion())
    number, quarter, strongest = check_numbers(sys.argv[1])
    if len(sys.argv) > 2:
        check_pictures(sys.argv[1], sys.argv[2], quarter, strongest)
    print("%d steps, %d comparisons: as the engine dumped it" % (number, compared))
