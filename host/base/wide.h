#pragma once

// A function that is also compiled for wider vectors, the program choosing as it starts; and one
// that such a function takes in whole.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__) && \
    !defined(__SANITIZE_ADDRESS__)
#define PF_WIDE [[gnu::target_clones("default", "avx2")]]
#define PF_INLINE [[gnu::always_inline]] inline
#else
#define PF_WIDE
#define PF_INLINE inline
#endif
