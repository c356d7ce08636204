// Powers for generated formulas (formula.h). GLSL's pow() is undefined for negative bases.

// base^exponent by repeated squaring; |exponent| <= 64, a constant. Written out, because compilers that
// do not unroll the loop take minutes for a long formula.
float integerPower(float base, int exponent) {
    precise float result = 1.0;
    precise float square = base;
    int n = abs(exponent);
    if ((n & 1) != 0) result = square;
    square *= square;
    if ((n & 2) != 0) result *= square;
    square *= square;
    if ((n & 4) != 0) result *= square;
    square *= square;
    if ((n & 8) != 0) result *= square;
    square *= square;
    if ((n & 16) != 0) result *= square;
    square *= square;
    if ((n & 32) != 0) result *= square;
    square *= square;
    if ((n & 64) != 0) result *= square;
    return exponent < 0 ? 1.0 / result : result;
}

// base^exponent as C defines it: a negative base has powers with whole exponents only.
float realPower(float base, float exponent) {
    if (exponent == 0.0) return 1.0;
    if (base > 0.0) return pow(base, exponent);
    if (base == 0.0) return exponent > 0.0 ? 0.0 : uintBitsToFloat(0x7f800000u);  // infinity
    if (exponent != floor(exponent)) return uintBitsToFloat(0x7fc00000u);         // not a number
    float magnitude = pow(-base, exponent);
    return mod(exponent, 2.0) == 0.0 ? magnitude : -magnitude;
}
