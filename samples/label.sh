#!/bin/sh
# Makes label.jpg, a photograph of a label that lies on a table, out of a drawing. Run it in the root of the project, with `pathwarp` in
# the PATH. The label has the ratio 5 : 4; its corners in the photograph are those of --target.
set -e
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

cat > "$folder/label.svg" <<'LABEL'
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="500" height="400" viewBox="0 0 500 400">
  <rect width="500" height="400" fill="#f6efdc"/>
  <rect x="12" y="12" width="476" height="376" fill="none" stroke="#1f3a4d" stroke-width="6"/>
  <rect x="22" y="22" width="456" height="356" fill="none" stroke="#1f3a4d" stroke-width="2"/>
  <circle cx="250" cy="112" r="66" fill="#c8472b"/>
  <g fill="none" stroke="#f6efdc" stroke-width="9" stroke-linecap="round">
    <circle cx="250" cy="72" r="10" stroke-width="7"/>
    <path d="M250 84V160M226 96H274M208 128Q212 160 250 160T292 128"/>
  </g>
  <g font-family="Noto Sans" fill="#1f3a4d" text-anchor="middle">
    <text x="250" y="238" font-size="50" textLength="400">HARBOUR</text>
    <text x="250" y="290" font-size="36" textLength="260">COFFEE</text>
    <text x="250" y="352" font-size="24" letter-spacing="3">dark roast, 250 g</text>
  </g>
  <path d="M60 312H440" stroke="#c8472b" stroke-width="3"/>
</svg>
LABEL

# The label where it lies; its page is the frame.
pathwarp projective "$folder/label.svg" --no-system-fonts --frame viewbox --fit none --quiet \
  --target '150,475 640,520 685,160 235,95' -o "$folder/lying.svg"

# The light, the table with its grain, the shadow, and the label without its page.
{
  cat <<'TABLE'
<svg xmlns="http://www.w3.org/2000/svg" width="800" height="600" viewBox="0 0 800 600">
  <defs>
    <linearGradient id="light" x1="0" y1="0" x2="1" y2="1">
      <stop offset="0" stop-color="#fff" stop-opacity=".28"/><stop offset="1" stop-color="#000" stop-opacity=".42"/>
    </linearGradient>
    <filter id="grain" x="0" y="0" width="1" height="1">
      <feTurbulence type="fractalNoise" baseFrequency=".004 .11" numOctaves="3" seed="7"/>
      <feColorMatrix values="0 0 0 0 .28  0 0 0 0 .15  0 0 0 0 .07  .9 0 0 0 0"/>
    </filter>
    <filter id="soft" x="-.2" y="-.2" width="1.4" height="1.4"><feGaussianBlur stdDeviation="9"/></filter>
  </defs>
  <rect width="800" height="600" fill="#a9733f"/>
  <g transform="rotate(-9 400 300)"><rect x="-100" y="-100" width="1000" height="800" filter="url(#grain)"/></g>
  <path d="M168 492L656 534L702 172L250 108Z" opacity=".55" filter="url(#soft)"/>
TABLE
  sed -e '/<svg /d' -e '/<\/svg>/d' "$folder/lying.svg"
  echo '<rect width="800" height="600" fill="url(#light)"/></svg>'
} > "$folder/table.svg"
pathwarp render "$folder/table.svg" --quality 80 -o samples/label.jpg
