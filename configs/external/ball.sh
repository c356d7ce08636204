#!/bin/sh
# ball.sh FACETS FOLDER: makes ball.stl in FOLDER and says how much of the ball's volume it lacks.
set -e
here=$(dirname "$0")
openscad -o "$2/ball.stl" -D "facets=$1" "$here/ball.scad"
# Each triangle and the origin span a tetrahedron; these fill the mesh.
awk '
    $1 == "vertex" { for (i = 0; i < 3; ++i) p[3 * n + i] = $(i + 2); ++n }
    n == 3 {
        six += p[0] * (p[4] * p[8] - p[5] * p[7]) + p[1] * (p[5] * p[6] - p[3] * p[8]) \
            + p[2] * (p[3] * p[7] - p[4] * p[6])
        n = 0
        ++triangles
    }
    END {
        whole = 4 / 3 * 3.141592653589793 * 10 ^ 3
        printf "{\"metric\": \"missing_volume\", \"value\": %.9g, \"unit\": \"1\"}\n", 1 - six / 6 / whole
        printf "{\"metric\": \"triangles\", \"value\": %d, \"unit\": \"triangle\"}\n", triangles
    }' "$2/ball.stl" >>"$GFXREPRO_METRICS_FILE"
