/// @file Bytes.h
/// Records of tiles as bytes, on their way from one part of a mesh to another.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

namespace vdbtet {

using Bytes = std::vector<char>;

template <typename T>
void pack(Bytes& bytes, const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* from = reinterpret_cast<const char*>(values);
    bytes.insert(bytes.end(), from, from + count * sizeof(T));
}
template <typename T>
void pack(Bytes& bytes, const T& value) {
    pack(bytes, &value, 1);
}
/// A list, after its length.
template <typename T>
void packList(Bytes& bytes, const std::vector<T>& values) {
    pack(bytes, values.size());
    pack(bytes, values.data(), values.size());
}

/// Reads what pack() has put there, in the same order.
class Unpacker {
public:
    explicit Unpacker(const Bytes& bytes) : mNext(bytes.data()), mEnd(bytes.data() + bytes.size()) {}

    template <typename T>
    void operator()(T* values, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (count == 0) return;
        std::memcpy(static_cast<void*>(values), mNext, count * sizeof(T));
        mNext += count * sizeof(T);
    }
    template <typename T>
    T next() {
        T value;
        (*this)(&value, 1);
        return value;
    }
    template <typename T>
    std::vector<T> nextList() {
        std::vector<T> values(next<std::size_t>());
        (*this)(values.data(), values.size());
        return values;
    }
    bool done() const { return mNext == mEnd; }

private:
    const char *mNext, *mEnd;
};

} // namespace vdbtet
