#ifndef RANDOM_GLSL
#define RANDOM_GLSL
// The lecture's rnd(t): a 24-bit linear congruential generator seeded by four rounds of the Tiny Encryption Algorithm
// (Zafar, Olano and Curtis 2010, "GPU Random Numbers via the Tiny Encryption Algorithm").

/// A seed from two numbers.
uint tea(uint v0, uint v1) {
    uint sum = 0u;
    for (int round = 0; round < 4; ++round) {
        sum += 0x9e3779b9u;
        v0 += ((v1 << 4) + 0xa341316cu) ^ (v1 + sum) ^ ((v1 >> 5) + 0xc8013ea4u);
        v1 += ((v0 << 4) + 0xad90777du) ^ (v0 + sum) ^ ((v0 >> 5) + 0x7e95761eu);
    }
    return v0;
}

/// The next number in [0, 1).
float rnd(inout uint t) {
    t = 1664525u * t + 1013904223u;
    return float(t & 0x00ffffffu) / float(0x01000000u);
}
#endif
