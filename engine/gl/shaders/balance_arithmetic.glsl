// The same arithmetic for fragments and compute invocations: `rounds` times 8 multiply-adds, each on
// what the last one gave, so that none can be left out. It turns points about the origin and
// neither grows nor fades, however long it goes on.
uniform int rounds;

vec4 arithmetic(vec2 seed) {
    vec4 a = vec4(seed, seed.yx);
    vec4 b = a.wzyx;
    for (int i = 0; i < rounds; ++i) {
        a = fma(b, vec4(0.5), a);
        b = fma(a, vec4(-0.5), b);
    }
    return a + b;
}
