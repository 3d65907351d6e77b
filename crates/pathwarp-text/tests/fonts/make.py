"""Makes the small fonts of the tests, and what HarfBuzz makes of text set in them.

    pip install fonttools==4.68.0 brotli uharfbuzz==0.57.0
    python make.py SOURCES

SOURCES is a folder with the fonts that README.md lists. Writes *.ttf, *.otf and harfbuzz.json beside this file.
"""

import json
import sys
from pathlib import Path

import uharfbuzz as hb
from fontTools import subset
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.recordingPen import RecordingPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont
from fontTools.varLib import instancer

HERE = Path(__file__).parent
BUNDLED = HERE / "../../../pathwarp-svg/fonts/NotoSans-Regular.subset.ttf"

# Name, source, new family name, characters, axes to drop.
FONTS = [
    ("hebrew.ttf", "NotoSansHebrew-Regular.ttf", "Pathwarp Test Hebrew", "שלוםברכה ָּׁ\u05b9", {}),
    ("arabic.ttf", "NotoSansArabic-Regular.ttf", "Pathwarp Test Arabic", "سلامعليكمبه َُِّ", {}),
    ("devanagari.ttf", "NotoSansDevanagari-Regular.ttf", "Pathwarp Test Devanagari", "क्षत्रियहिन्दीकर्मा ", {}),
    ("variable.ttf", "noto-sans-latin-standard-normal.woff2", "Pathwarp Test Variable", "AVHOToxnefi ", {}),
    ("cff.otf", "Cantarell-Regular.otf", "Pathwarp Test Cff", "Hxaofils ", {}),
]

# Scripts in several of which one text is set. They keep the names by which fonts for a script are found. Name, source, characters.
SCRIPTS = [
    ("arabic.ttf", "NotoSansArabic-Regular.ttf", "مرحبا بالعالم السلام عليكم ١٢٣ ()"),
    ("armenian.ttf", "NotoSansArmenian-Regular.ttf", "ԲարեւՀայաստան"),
    ("bengali.ttf", "NotoSansBengali-Regular.ttf", "নমস্কারবাংলাশ্রীহিন্দী"),
    ("devanagari.ttf", "NotoSansDevanagari-Regular.ttf", "नमस्तेदुनियाहिन्दीक्षत्रियकर्म।"),
    ("georgian.ttf", "NotoSansGeorgian-Regular.ttf", "გამარჯობა"),
    ("hebrew.ttf", "NotoSansHebrew-Regular.ttf", "שלוםעולם שָׁלוֹם ()"),
    ("japanese.otf", "NotoSansCJK-Regular.ttc", "日本語縦書きかな漢字、（）ー"),
    ("khmer.ttf", "NotoSansKhmer-Regular.ttf", "សួស្តីខ្មែរ"),
    ("thai.ttf", "NotoSansThai-Regular.ttf", "สวัสดีภาษาไทยน้ำ\u0e4d"),
]

# Name, font, text, direction, script, language, features, variations.
CASES = [
    ("hebrew", "hebrew.ttf", "שלום", "rtl", "Hebr", "he", {}, {}),
    ("hebrew with points", "hebrew.ttf", "שָּׁלוֹם", "rtl", "Hebr", "he", {}, {}),
    ("arabic joins", "arabic.ttf", "سلام عليكم", "rtl", "Arab", "ar", {}, {}),
    ("arabic with marks", "arabic.ttf", "مَّعَهُ", "rtl", "Arab", "ar", {}, {}),
    ("arabic lam-alef", "arabic.ttf", "لا", "rtl", "Arab", "ar", {}, {}),
    ("devanagari conjuncts", "devanagari.ttf", "क्षत्रिय", "ltr", "Deva", "hi", {}, {}),
    ("devanagari vowel before", "devanagari.ttf", "हिन्दी", "ltr", "Deva", "hi", {}, {}),
    ("devanagari reph", "devanagari.ttf", "कर्म कर्मा", "ltr", "Deva", "hi", {}, {}),
    ("kerning", "bundled", "AVATo We", "ltr", "Latn", "en", {}, {}),
    ("no kerning", "bundled", "AVATo We", "ltr", "Latn", "en", {"kern": False}, {}),
    ("marks", "bundled", "e\u0301x\u0308 q\u0302", "ltr", "Latn", "en", {}, {}),
    ("ligature", "bundled", "office", "ltr", "Latn", "en", {}, {}),
    ("no ligature", "bundled", "office", "ltr", "Latn", "en", {"liga": False}, {}),
    ("default place", "variable.ttf", "AVo Hx", "ltr", "Latn", "en", {}, {}),
    ("semibold", "variable.ttf", "AVo Hx", "ltr", "Latn", "en", {}, {"wght": 600}),
    ("thin and narrow", "variable.ttf", "AVo Hx", "ltr", "Latn", "en", {}, {"wght": 137, "wdth": 71.5}),
    ("black", "variable.ttf", "Tofe", "ltr", "Latn", "en", {}, {"wght": 900}),
    ("cff", "cff.otf", "Hafilox", "ltr", "Latn", "en", {}, {}),
    ("cff alternates", "cff.otf", "Hafilox", "ltr", "Latn", "en", {"ss01": True, "liga": False}, {}),
]


def make(sources, name, source, family, text, drop):
    # The time of change stays the source's: the same bytes every time.
    font = TTFont(sources / source, fontNumber=0, recalcTimestamp=False)
    font.flavor = None
    if drop:
        font = instancer.instantiateVariableFont(font, drop)
    options = subset.Options()
    options.layout_features = ["*"]
    options.name_IDs = [0, 1, 2, 3, 4, 5, 6, 13, 14]
    options.hinting = False
    options.notdef_outline = True
    options.glyph_names = False
    options.drop_tables += ["DSIG", "meta"]
    cut = subset.Subsetter(options)
    cut.populate(text=text)
    cut.subset(font)
    plain = (family or "").replace(" ", "")
    for record in list(font["name"].names) if family else []:
        new = {1: family, 3: plain, 4: family, 6: plain}.get(record.nameID)
        if new:
            font["name"].setName(new, record.nameID, record.platformID, record.platEncID, record.langID)
    if family and "CFF " in font:
        cff = font["CFF "].cff
        cff.fontNames = [plain]
        top = cff.topDictIndex[0]
        for key in ("FullName", "FamilyName"):
            if hasattr(top, key):
                setattr(top, key, family)
    font.save(HERE / name)


def make_emoji():
    """A font of our own with two faces in colours: the first one of layers (COLR 0), the second one of gradients (COLR 1)."""

    def disc(x, y, r):
        pen = TTGlyphPen(None)
        k = 0.414 * r
        pen.moveTo((x + r, y))
        for ax, ay, bx, by, cx, cy in [(1, k / r, k / r, 1, 0, 1), (-k / r, 1, -1, k / r, -1, 0),
                                       (-1, -k / r, -k / r, -1, 0, -1), (k / r, -1, 1, -k / r, 1, 0)]:
            pen.qCurveTo(*[(round(x + r * a), round(y + r * b)) for a, b in ((ax, ay), (bx, by), (cx, cy))])
        pen.closePath()
        return pen.glyph()

    glyphs = {".notdef": disc(500, 350, 200), "space": TTGlyphPen(None).glyph(), "first": disc(500, 350, 440),
              "second": disc(500, 350, 440), "face": disc(500, 350, 440), "left": disc(350, 450, 70),
              "right": disc(650, 450, 70)}
    font = FontBuilder(1000, isTTF=True)
    font.setupGlyphOrder(list(glyphs))
    font.setupCharacterMap({32: "space", 0x1F600: "first", 0x1F601: "second"})
    font.setupGlyf(glyphs)
    left = {".notdef": 300, "space": 0, "left": 280, "right": 580}
    font.setupHorizontalMetrics({g: (1000, left.get(g, 60)) for g in glyphs})
    font.setupHorizontalHeader(ascent=900, descent=-200)
    font.setupNameTable({"familyName": "Pathwarp Test Emoji", "styleName": "Regular", "psName": "PathwarpTestEmoji"})
    font.setupOS2(sTypoAscender=900, sTypoDescender=-200, usWinAscent=900, usWinDescent=200)
    font.setupPost()
    font.setupCPAL([[(1.0, 0.8, 0.2, 1.0), (0.2, 0.1, 0.0, 1.0), (0.9, 0.3, 0.1, 1.0)]])

    def layer(glyph, paint):
        return {"Format": 10, "Glyph": glyph, "Paint": paint}

    def stops(a, b):
        return {"ColorStop": [(0.0, a), (1.0, b)], "Extend": "pad"}

    eye = {"Format": 2, "PaletteIndex": 1, "Alpha": 0.5}
    glow = {"Format": 6, "ColorLine": stops(0, 2), "x0": 500, "y0": 350, "r0": 0, "x1": 500, "y1": 350, "r1": 440}
    sky = {"Format": 4, "ColorLine": stops(2, 1), "x0": 280, "y0": 0, "x1": 420, "y1": 0, "x2": 280, "y2": 100}
    font.setupCOLR({
        "first": [("face", 0), ("left", 1), ("right", 1)],
        "second": (1, [layer("face", glow), layer("left", sky), layer("right", eye)]),
    })
    font.font["head"].created = font.font["head"].modified = 0
    font.font.recalcTimestamp = False
    font.save(HERE / "../scripts/emoji.ttf")


def rounded(v):
    return round(float(v), 4)


def shape(path, text, direction, script, language, features, variations):
    blob = hb.Blob.from_file_path(path)
    font = hb.Font(hb.Face(blob))
    if variations:
        font.set_variations(variations)
    buffer = hb.Buffer()
    buffer.add_utf8(text.encode())
    buffer.direction, buffer.script, buffer.language = direction, script, language
    hb.shape(font, buffer, features)
    glyphs = [
        [i.codepoint, i.cluster, p.x_advance, p.x_offset, p.y_offset]
        for i, p in zip(buffer.glyph_infos, buffer.glyph_positions)
    ]
    outlines = {}
    for g in sorted({g[0] for g in glyphs}):
        pen = RecordingPen()
        font.draw_glyph_with_pen(g, pen)
        outlines[str(g)] = [[op, [rounded(c) for point in points for c in point]] for op, points in pen.value]
    extents = font.get_font_extents("ltr")
    heights = {"ascent": extents.ascender, "descent": -extents.descender, "line_gap": extents.line_gap}
    for key, tag in (("cap_height", hb.OTMetricsTag.CAP_HEIGHT), ("x_height", hb.OTMetricsTag.X_HEIGHT)):
        heights[key] = font.get_metric_position(tag)
    return glyphs, outlines, heights


def main(sources):
    for row in FONTS:
        make(sources, *row)
    for name, source, text in SCRIPTS:
        make(sources, f"../scripts/{name}", source, None, text, {})
    make_emoji()
    out = {"harfbuzz": hb.version_string(), "cases": []}
    for name, file, text, direction, script, language, features, variations in CASES:
        path = BUNDLED if file == "bundled" else HERE / file
        glyphs, outlines, heights = shape(path, text, direction, script, language, features, variations)
        out["cases"].append({
            "name": name, "font": file, "text": text, "direction": direction, "script": script, "language": language,
            "features": {k: int(v) for k, v in features.items()}, "variations": variations,
            "upem": TTFont(path)["head"].unitsPerEm,
            "heights": heights, "glyphs": glyphs, "outlines": outlines,
        })
    lines = ",\n".join(json.dumps(c, ensure_ascii=False) for c in out["cases"])
    text = f'{{"harfbuzz": "{out["harfbuzz"]}", "cases": [\n{lines}\n]}}\n'
    (HERE / "harfbuzz.json").write_text(text)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
