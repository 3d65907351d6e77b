"""Measures `pathwarp simplify` from outside.

    python3 -m venv v; v/bin/pip install shapely svgpathtools pillow potracer vtracer; npm install paper@0.12
    v/bin/python measure.py forty --program ../../target/release/pathwarp   # beside paper.js and Inkscape
    v/bin/python measure.py random 1200 --program ../../target/release/pathwarp   # against Shapely

Distances are those of points sampled along both outlines from the other one, as Shapely measures them.
"""
import argparse, io, math, os, random, re, subprocess, sys, tempfile

from shapely import STRtree
from shapely.geometry import LineString, Point, Polygon
from svgpathtools import Line, parse_path

SIZE = 400


def points(d, step):
    """The subpaths of path data, as points along them."""
    out = []
    for sub in parse_path(d).continuous_subpaths():
        p = []
        for s in sub:
            length = abs(s.end - s.start) if isinstance(s, Line) else s.length(error=1e-3)
            n = max(1 if isinstance(s, Line) else 16, min(400, math.ceil(length / step)))
            p += [s.point(i / n) for i in range(n)]
        if len(sub):
            p.append(sub[-1].end)
            out.append([(z.real, z.imag) for z in p])
    return out


def apart(a, b, step=0.5):
    """The Hausdorff distance of two paths, sampled."""
    a, b = points(a, step), points(b, step)

    def one(from_, to):
        pieces = [LineString(w) for p in to for w in zip(p, p[1:]) if w[0] != w[1]] or [Point(to[0][0])]
        tree = STRtree(pieces)
        places = [Point(q) for p in from_ for q in p]
        nearest = tree.nearest(places)
        return max(q.distance(pieces[i]) for q, i in zip(places, nearest))

    return max(one(a, b), one(b, a))


def nodes(d):
    return sum(1 for s in parse_path(d) if s.start != s.end)


def drawing(d):
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE} {SIZE}"><path id="a" d="{d}"/></svg>'


def data(svg):
    return re.search(r'\sd="([^"]*)"', svg).group(1)


def simplified(program, d, tolerance, *options):
    command = [program, "simplify", "-", "--tolerance", f"{tolerance:.9f}", "--quiet", *options]
    run = subprocess.run(command, input=drawing(d), capture_output=True, text=True)
    if run.returncode:
        raise RuntimeError(f"{run.stderr}: {drawing(d)[:3000]}")
    return data(run.stdout)


def polygon(p, closed=True, digits=2):
    return "M" + "L".join(f"{x:.{digits}f},{y:.{digits}f}" for x, y in p) + ("Z" if closed else "")


# The forty drawings.


def star(tips, r, inner, turn=0.2, at=(200, 200)):
    ray = lambda i: r if i % 2 == 0 else inner
    angle = lambda i: turn + math.pi * i / tips
    return [(at[0] + ray(i) * math.cos(angle(i)), at[1] + ray(i) * math.sin(angle(i))) for i in range(2 * tips)]


def gear(teeth):
    out = []
    for i in range(teeth):
        for a, r in [(0, 130), (0.25, 170), (0.5, 170), (0.75, 130)]:
            f = math.tau * (i + a) / teeth
            out.append((200 + r * math.cos(f), 200 + r * math.sin(f)))
    return out


def bitmaps():
    """Eight black and white pictures."""
    from PIL import Image, ImageDraw, ImageFont

    def picture(draw_it):
        image = Image.new("1", (SIZE, SIZE), 1)
        draw_it(ImageDraw.Draw(image))
        return image

    def letter(text, size):
        font = ImageFont.load_default(size)
        return lambda d: d.text((200, 200), text, fill=0, font=font, anchor="mm")

    def ring(d):
        d.ellipse((60, 60, 340, 340), fill=0)
        d.ellipse((130, 120, 300, 290), fill=1)

    def leaf(d):
        f = lambda t: (200 + 150 * math.sin(math.pi * t) * math.sin(0.5 + 2 * t), 40 + 320 * t)
        g = lambda t: (200 - 120 * math.sin(math.pi * t) ** 2, 40 + 320 * t)
        d.polygon([f(i / 200) for i in range(201)] + [g(1 - i / 200) for i in range(201)], fill=0)

    return {
        "S": picture(letter("S", 420)),
        "ag": picture(letter("ag", 250)),
        "R&K": picture(letter("R&K", 170)),
        "star": picture(lambda d: d.polygon(star(5, 180, 75), fill=0)),
        "gear": picture(lambda d: d.polygon(gear(14), fill=0)),
        "ring": picture(ring),
        "leaf": picture(leaf),
        "box": picture(lambda d: d.rounded_rectangle((50, 90, 350, 310), 60, fill=0)),
    }


def pixel_outline(image):
    """The edges of pixels between black and white, chained."""
    px = image.load()
    black = lambda x, y: 0 <= x < SIZE and 0 <= y < SIZE and px[x, y] == 0
    nexts = {}
    for y in range(SIZE):
        for x in range(SIZE):
            if black(x, y):
                for inside, a, b in [
                    (black(x, y - 1), (x, y), (x + 1, y)),
                    (black(x + 1, y), (x + 1, y), (x + 1, y + 1)),
                    (black(x, y + 1), (x + 1, y + 1), (x, y + 1)),
                    (black(x - 1, y), (x, y + 1), (x, y)),
                ]:
                    if not inside:
                        nexts.setdefault(a, []).append(b)
    out = ""
    while nexts:
        at = start = next(iter(nexts))
        ring = []
        while True:
            ring.append(at)
            after = nexts[at].pop()
            if not nexts[at]:
                del nexts[at]
            at = after
            if at == start:
                break
        out += polygon(ring, digits=0)
    return out


def traced_by_potrace(image):
    import potrace

    out = ""
    for curve in potrace.Bitmap(image).trace():
        out += f"M{curve.start_point.x:.2f},{curve.start_point.y:.2f}"
        for s in curve.segments:
            p = [s.c, s.end_point] if s.is_corner else [s.c1, s.c2, s.end_point]
            xy = [f"{q.x:.2f},{q.y:.2f}" for q in p]
            out += "L" + " L".join(xy) if s.is_corner else "C" + " ".join(xy)
        out += "Z"
    return out


def traced_by_vtracer(image, mode):
    import vtracer

    raw = io.BytesIO()
    image.convert("RGB").save(raw, "PNG")
    svg = vtracer.convert_raw_image_to_svg(raw.getvalue(), img_format="png", colormode="binary", mode=mode)
    out = ""
    for path in re.finditer(r"<path ([^>]*)>", svg):
        d = re.search(r'd="([^"]*)"', path[1])[1]
        move = re.search(r"translate\(([-\d.]+),([-\d.]+)\)", path[1])
        dx, dy = (float(move[1]), float(move[2])) if move else (0, 0)
        moved = parse_path(d).translated(complex(dx, dy))
        out += " ".join(s.d() for s in moved.continuous_subpaths())
        out += "Z" if "Z" in d.upper() else ""
    return out


def track(r, noise):
    """A walk as a GPS receiver records it: a point a second or so, with wandering errors."""
    x, y, heading, turn, off = 60.0, 200.0, 0.0, 0.0, [0.0, 0.0]
    out = []
    for i in range(900):
        turn = 0.97 * turn + r.gauss(0, 0.01)
        heading += turn + 0.02 * (math.atan2(200 - y, 200 - x) - heading) * (math.hypot(x - 200, y - 200) > 150)
        x, y = x + 1.2 * math.cos(heading), y + 1.2 * math.sin(heading)
        off = [0.8 * v + r.gauss(0, noise) for v in off]
        out.append((x + off[0], y + off[1]))
    return polygon(out, False)


def coast(r, rounds):
    """A closed border of midpoints that are moved by chance."""
    ring = [(200 + 150 * math.cos(math.tau * i / 6), 200 + 150 * math.sin(math.tau * i / 6)) for i in range(6)]
    for k in range(rounds):
        by = 22 * 0.52**k
        pairs = zip(ring, ring[1:] + ring[:1])
        ring = [q for a, b in pairs for q in (a, ((a[0] + b[0]) / 2 + r.gauss(0, by), (a[1] + b[1]) / 2 + r.gauss(0, by)))]
    return polygon(ring)


def facets(kind):
    """Outlines as CAD programs flatten them."""
    arc = lambda x, y, r, a, b, n: [
        (x + r * math.cos(math.radians(a + (b - a) * i / n)), y + r * math.sin(math.radians(a + (b - a) * i / n))) for i in range(n + 1)
    ]
    box = lambda r, n: arc(340 - r, 300 - r, r, 0, 90, n) + arc(60 + r, 300 - r, r, 90, 180, n) + arc(60 + r, 100 + r, r, 180, 270, n) + arc(340 - r, 100 + r, r, 270, 360, n)
    slot = arc(280, 200, 60, -90, 90, 32) + arc(120, 200, 60, 90, 270, 32)
    flange = arc(200, 200, 160, 0, 360, 180)[:-1]
    if kind == "box":
        return polygon(box(40, 12), digits=4)
    if kind == "slot":
        return polygon(slot, digits=4)
    if kind == "flange":
        holes = [arc(200 + 110 * math.cos(a), 200 + 110 * math.sin(a), 20, 0, 360, 36)[:-1] for a in (0, 2.1, 4.2)]
        return polygon(flange, digits=4) + "".join(polygon(h, digits=4) for h in holes)
    spline = [(40 + 320 * t, 200 + 90 * math.sin(7 * t) * t) for t in (i / 160 for i in range(161))]
    return polygon(spline, False, 4)


def forty():
    out, pictures = {}, bitmaps()
    for name, image in pictures.items():
        out[f"potrace {name}"] = traced_by_potrace(image)
        out[f"vtracer {name}"] = traced_by_vtracer(image, "spline" if name not in ("star", "box") else "polygon")
        out[f"pixels {name}"] = pixel_outline(image)
    for i in range(6):
        out[f"GPS {i}"] = track(random.Random(i), 0.3 + 0.15 * i)
    for i in range(6):
        out[f"border {i}"] = coast(random.Random(60 + i), 5 + i % 3)
    for kind in ("box", "slot", "flange", "spline"):
        out[f"CAD {kind}"] = facets(kind)
    return out


PAPER = """
const paper = require('paper/dist/paper-core'); paper.setup(new paper.Size(400, 400));
let text = ''; process.stdin.on('data', c => text += c).on('end', () => {
  const out = JSON.parse(text).map(d => {
    const item = new paper.CompoundPath(d);
    for (const path of item.children) path.simplify();
    return item.pathData;
  });
  console.log(JSON.stringify(out));
});
"""


def by_paper(all_data):
    import json

    here = os.path.dirname(os.path.abspath(__file__))
    modules = os.pathsep.join([os.path.join(os.getcwd(), "node_modules"), os.path.join(here, "node_modules")])
    run = subprocess.run(["node", "-e", PAPER], input=json.dumps(all_data), capture_output=True, text=True, env={**os.environ, "NODE_PATH": modules}, check=True)
    return json.loads(run.stdout)


def by_inkscape(all_data):
    out = []
    with tempfile.TemporaryDirectory() as folder:
        for d in all_data:
            source, target = os.path.join(folder, "a.svg"), os.path.join(folder, "b.svg")
            with open(source, "w") as f:
                f.write(drawing(d))
            actions = f"select-all;path-simplify;export-plain-svg;export-filename:{target};export-do"
            subprocess.run(["inkscape", f"--actions={actions}", source], capture_output=True, check=True)
            with open(target) as f:
                out.append(data(f.read()))
    return out


def compare(program):
    drawings = forty()
    names, sources = list(drawings), list(drawings.values())
    others = {"paper.js": by_paper(sources), "Inkscape": by_inkscape(sources)}
    sums, worse = {}, []
    for i, (name, d) in enumerate(zip(names, sources)):
        counts, distances = [nodes(d)], []
        for other, results in others.items():
            distances.append(apart(d, results[i], 0.25))
            theirs, ours = nodes(results[i]), nodes(simplified(program, d, max(distances[-1], 1e-3)))
            counts += [theirs, ours]
            if ours > 1.05 * theirs + 1:
                worse.append(f"{name}: {ours} of {other}'s {theirs}")
        print(name, counts, [round(x, 2) for x in distances], file=sys.stderr)
        for key in (name.split()[0], "all forty"):
            sums[key] = [a + b for a, b in zip(sums.get(key, [0] * 5), counts)]
    print("| | before | paper.js | ours, as far off | Inkscape | ours, as far off |\n|---|---|---|---|---|---|")
    for key in sorted(sums, key=lambda k: (k == "all forty", k)):
        print(f"| {key} | " + " | ".join(f"{n:,}" for n in sums[key]) + " |")
    print("More than 5 % + 1 nodes above another's:", "; ".join(worse) or "none")


def case(r):
    """A random outline of one of five kinds, and a tolerance."""
    kind = r.choice(["noise", "pixels", "stairs", "track", "curves"])
    n = r.randrange(20, 300)
    wave = [r.uniform(0, 0.25) for _ in range(4)]
    phase = [r.uniform(0, math.tau) for _ in range(4)]
    radius = lambda f: 120 * (1 + sum(w * math.cos((k + 2) * f + p) for k, (w, p) in enumerate(zip(wave, phase))) / 2)
    at = lambda f: (200 + radius(f) * math.cos(f), 200 + radius(f) * math.sin(f))
    ring = [at(math.tau * i / n) for i in range(n)]
    tolerance = 10 ** r.uniform(-1, 0.8)
    if kind == "noise":
        s = tolerance * r.choice([0.05, 0.15, 0.6])
        return kind, polygon([(x + r.gauss(0, s), y + r.gauss(0, s)) for x, y in ring], digits=4), tolerance
    if kind == "pixels":
        g = r.choice([1, 2, 5])
        p = [(g * round(x / g), g * round(y / g)) for x, y in ring]
        stairs = [q for a, b in zip(p, p[1:] + p[:1]) for q in (a, (b[0], a[1]))]
        return kind, polygon(stairs, digits=0), tolerance
    if kind == "stairs":
        return kind, polygon(star(r.randrange(3, 9), r.uniform(30, 180), r.uniform(10, 90), r.uniform(0, 6))), tolerance
    if kind == "track":
        return kind, track(r, r.uniform(0.1, 1)), tolerance
    d = f"M{ring[0][0]:.3f},{ring[0][1]:.3f}"
    for a, b in zip(ring, ring[1:] + ring[:1]):
        c = [(a[0] + (b[0] - a[0]) * t + r.gauss(0, 1), a[1] + (b[1] - a[1]) * t + r.gauss(0, 1)) for t in (1 / 3, 2 / 3)]
        d += "C" + " ".join(f"{x:.3f},{y:.3f}" for x, y in [*c, b])
    return kind, d + "Z", tolerance


def check(program, count):
    worst, crossed, before, after, faults = 0.0, 0, 0, 0, 0
    for seed in range(count):
        kind, d, tolerance = case(random.Random(seed))
        result = simplified(program, d, tolerance)
        share = apart(d, result, max(0.5 * tolerance, 0.3)) / tolerance
        worst = max(worst, share)
        before, after = before + nodes(d), after + nodes(result)
        # A simple outline without necks and bays that the tolerance closes stays simple.
        was, now = [points(x, max(tolerance, 0.5))[0] for x in (d, result)]
        area = Polygon(was)
        clear = kind != "track" and area.is_valid and all(
            p.geom_type == "Polygon" and not p.is_empty and not p.interiors for p in (area.buffer(k * tolerance) for k in (-2.5, 2.5))
        )
        crosses = clear and len(now) > 3 and not Polygon(now).is_valid
        crossed += crosses
        if share > 1.001 or crosses or nodes(result) > nodes(d):
            faults += 1
            print(f"{seed} {kind}: {share:.4f} of tolerance {tolerance:.4f}, crosses: {crosses}, {nodes(d)} nodes -> {nodes(result)}", flush=True)
    print(f"{count} cases, {before} nodes became {after}; largest distance {worst:.4f} tolerances; {crossed} cross themselves; {faults} faults")
    return faults


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["forty", "random"])
    parser.add_argument("count", nargs="?", type=int, default=1000)
    parser.add_argument("--program", default="pathwarp")
    given = parser.parse_args()
    sys.exit(compare(given.program) if given.what == "forty" else min(1, check(given.program, given.count)))
