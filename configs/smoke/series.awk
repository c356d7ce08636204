# Leibniz's series for π of `terms` terms.
BEGIN {
    for (i = 0; i < terms; ++i) sum += (i % 2 ? -4 : 4) / (2 * i + 1)
    error = sum - 3.141592653589793
    printf "{\"metric\": \"error\", \"value\": %.9g, \"unit\": \"1\"}\n", error < 0 ? -error : error \
        >>ENVIRON["GFXREPRO_METRICS_FILE"]
}
