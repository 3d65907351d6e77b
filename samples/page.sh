#!/bin/sh
# Makes page.jpg, a photograph of a curved page of a book, out of a drawing. Run it in the root of the project, with `pathwarp` in the
# PATH. The four sides of the page in the photograph are those of --shaper.
set -e
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

# The words are the beginning of Alice's Adventures in Wonderland (Lewis Carroll, 1865).
cat > "$folder/page.svg" <<'PAGE'
<svg xmlns="http://www.w3.org/2000/svg" width="540" height="450" viewBox="0 0 540 450" font-family="Noto Sans" fill="#2b241c">
  <rect width="540" height="450" fill="#f5eedd"/>
  <text x="270" y="66" font-size="22" text-anchor="middle" letter-spacing="2">CHAPTER I</text>
  <text x="270" y="98" font-size="17" text-anchor="middle">Down the Rabbit-Hole</text>
  <path d="M220 114H320" stroke="#a33" stroke-width="2"/>
  <g font-size="17">
    <text x="50" y="154" textLength="440">Alice was beginning to get very tired of sitting by her</text>
    <text x="50" y="182" textLength="440">sister on the bank, and of having nothing to do: once</text>
    <text x="50" y="210" textLength="440">or twice she had peeped into the book her sister was</text>
    <text x="50" y="238" textLength="440">reading, but it had no pictures or conversations in it,</text>
    <text x="50" y="266" textLength="440">“and what is the use of a book,” thought Alice,</text>
    <text x="50" y="294">“without pictures or conversations?”</text>
    <text x="70" y="330" textLength="420">So she was considering in her own mind, as well as</text>
    <text x="50" y="358" textLength="440">she could, for the hot day made her feel very sleepy</text>
    <text x="50" y="386" textLength="440">and stupid, whether the pleasure of making a daisy-chain</text>
    <text x="50" y="414" textLength="440">would be worth the trouble of getting up.</text>
  </g>
</svg>
PAGE

# The page where it lies; its edges are the frame.
side='M70,520 C180,415 430,425 660,505 L690,115 C450,15 190,10 100,130 Z'
pathwarp shaper "$folder/page.svg" --no-system-fonts --frame viewbox --fit none --quiet --shaper "$side" -o "$folder/lying.svg"

# The desk, the shadow, the page without its own page, and the light along its curve.
{
  cat <<DESK
<svg xmlns="http://www.w3.org/2000/svg" width="760" height="570" viewBox="0 0 760 570">
  <defs>
    <linearGradient id="light" x1="0" x2="1">
      <stop offset="0" stop-opacity=".5"/><stop offset=".28" stop-opacity="0"/><stop offset=".6" stop-color="#fff" stop-opacity=".12"/>
      <stop offset="1" stop-opacity=".25"/>
    </linearGradient>
    <filter id="soft" x="-.2" y="-.2" width="1.4" height="1.4"><feGaussianBlur stdDeviation="10"/></filter>
  </defs>
  <rect width="760" height="570" fill="#54606b"/>
  <path d="$side" transform="translate(10 16)" opacity=".6" filter="url(#soft)"/>
DESK
  sed -e '/<svg /d' -e '/<\/svg>/d' "$folder/lying.svg" | sed '1i <g font-family="Noto Sans" fill="#2b241c">' | sed '$a </g>'
  echo "<path d=\"$side\" fill=\"url(#light)\"/></svg>"
} > "$folder/desk.svg"
pathwarp render "$folder/desk.svg" --quality 80 -o samples/page.jpg
