#!/bin/sh
# tilt: a slant that grows towards the top, as a plug-in in shell and awk.
cat <<'ENTRY'
{
  "pathwarp-plugin": 2,
  "protocol": "text",
  "name": "tilt",
  "title": "a slant that grows towards the top",
  "about": "Pushes points to the right, the more the higher they lie above the bottom of the artwork.",
  "source": "the plug-in pathwarp-tilt.sh",
  "parameters": [
    {"name": "push", "kind": "length", "axis": "x", "default": "20%", "slider": [-100, 100],
     "help": "How far the top is pushed to the right."},
    {"name": "power", "kind": "number", "default": 2, "range": [1, 6],
     "help": "Growth of the push with the height: 1 slants, 2 bends like a blade of grass."}
  ],
  "examples": [
    {"what": "As it comes", "command": "tilt samples/logo.svg -o out.svg"},
    {"what": "Straight", "command": "tilt samples/logo.svg --power 1 --push -30% -o out.svg"}
  ],
  "laws": [{"identity": {"push": 0}}, {"keeps-lines": {"power": 1}}, {"area": [{}, 1]}],
  "cases": [{"args": {"push": "10", "power": "2"}, "at": [5, 50], "to": [7.5, 50], "tolerance": 1e-12}]
}
ENTRY

# The next $1 lines.
lines() {
    i=0
    while [ "$i" -lt "$1" ]; do
        read -r line
        echo "$line"
        i=$((i + 1))
    done
}

# An awk for each batch, as it reads more than it needs. All digits: %.17g.
while read -r command count; do
    case $command in
    build)
        VALUES=$(lines "$count")
        export VALUES
        echo ok
        ;;
    points)
        lines "$count" | awk '
            BEGIN {
                n = split(ENVIRON["VALUES"], all, "\n")
                for (i = 1; i <= n; i++) {
                    split(all[i], word, " ")
                    value[word[1]] = word[2]
                    if (word[1] == "frame") { top = word[3]; bottom = word[5] }
                }
            }
            {
                up = (bottom - $2) / (bottom - top)
                sign = up < 0 ? -1 : 1
                printf "%.17g %.17g\n", $1 + value["push"] * sign * (sign * up) ^ value["power"], $2
            }'
        ;;
    esac
done
