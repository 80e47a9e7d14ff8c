/// @file Stream.h
/// Stores that go to memory without reading the line before: half the traffic for what no one reads soon.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace vdbtet {

/// Store two numbers at @a to, which is aligned to 16 bytes.
inline void streamPair(std::int64_t* to, std::int64_t a, std::int64_t b) {
#if defined(__SSE2__)
    _mm_stream_si128(reinterpret_cast<__m128i*>(to), _mm_set_epi64x(b, a));
#else
    to[0] = a;
    to[1] = b;
#endif
}

inline void stream(double* to, double value) {
#if defined(__SSE2__) && defined(__x86_64__)
    long long bits;
    std::memcpy(&bits, &value, sizeof bits);
    _mm_stream_si64(reinterpret_cast<long long*>(to), bits);
#else
    *to = value;
#endif
}

/// Must come between these stores and telling another thread of it.
inline void drainStores() {
#if defined(__SSE2__)
    _mm_sfence();
#endif
}

} // namespace vdbtet
