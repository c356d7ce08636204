// Loops over many floats for processors with wider registers.
#pragma once

// A function compiled twice, and chosen by the processor: eight values at once, or four. The bits
// are the same, as no product is fused with a sum (-ffp-contract=off).
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GFXREPRO_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define GFXREPRO_WIDE
#endif
