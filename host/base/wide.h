#pragma once

// PF_WIDE: cloned for AVX2, selected at load time. PF_WIDE_INLINE: always inlined into such
// functions.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PF_WIDE [[gnu::target_clones("default", "avx2")]]
#define PF_WIDE_INLINE [[gnu::always_inline]] inline
#else
#define PF_WIDE
#define PF_WIDE_INLINE inline
#endif
