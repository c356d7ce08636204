# Series for π of `terms` terms, Leibniz's or Nilakantha's.
BEGIN {
    sum = series == "leibniz" ? 0 : 3
    for (i = 0; i < terms; ++i) {
        k = 2 * i + 2
        sum += (i % 2 ? -4 : 4) / (series == "leibniz" ? k - 1 : k * (k + 1) * (k + 2))
    }
    error = sum - 3.141592653589793
    printf "{\"metric\": \"error\", \"value\": %.9g, \"unit\": \"1\"}\n", error < 0 ? -error : error \
        >>ENVIRON["GFXREPRO_METRICS_FILE"]
}
