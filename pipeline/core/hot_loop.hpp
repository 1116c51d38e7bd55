#pragma once

/// Marks a free function whose loops the compiler vectorises twice: for every x86-64 and for those
/// with AVX2, chosen when the program is loaded. (-march=native would crash with Debian's PCL.)
/// Sanitizers run code of their own before the
/// choice can be made, so they get the plain one.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define KINECTLAB_HOT_LOOP __attribute__((target_clones("avx2", "default")))
#else
#define KINECTLAB_HOT_LOOP
#endif
