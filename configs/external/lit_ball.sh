#!/bin/sh
# lit_ball.sh WIDTH HEIGHT SAMPLES SEED PICTURE: a renderer, as small as one can be. It draws a ball in the sun by random
# samples of each pixel, and says how long that took.
set -e
begin=$(date +%s%N)
awk -v width="$1" -v height="$2" -v samples="$3" -v seed="$4" 'BEGIN {
    srand(seed)
    print "P2", width, height, 255
    for (y = 0; y < height; ++y) {
        for (x = 0; x < width; ++x) {
            light = 0
            for (i = 0; i < samples; ++i) {
                u = 2.2 * ((x + rand()) / width - 0.5)
                v = 2.2 * (0.5 - (y + rand()) / height)
                inside = 1 - u * u - v * v
                cosine = inside > 0 ? 0.48 * u + 0.6 * v + 0.64 * sqrt(inside) : 0
                if (cosine > 0) light += cosine
            }
            printf "%d\n", 255 * sqrt(light / samples) + 0.5
        }
    }
}' >"$5"
us=$((($(date +%s%N) - begin) / 1000))
printf '{"metric": "render_ms", "value": %d.%03d, "unit": "ms"}\n' $((us / 1000)) $((us % 1000)) >>"$GFXREPRO_METRICS_FILE"
