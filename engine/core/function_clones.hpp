#pragma once

/// Before a function that decides outcomes: on the oldest x86-64 std::fma and std::floor are library calls; the clone
/// for newer machines has the same bits. (The sanitizers are not ready yet when the clone is chosen, and clang takes no
/// clones of a flattened function.)
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define STEERSTAT_CLONED [[gnu::target_clones("default", "fma"), gnu::flatten]]
#else
#define STEERSTAT_CLONED
#endif
