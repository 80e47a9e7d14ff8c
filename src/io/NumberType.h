/// @file NumberType.h
/// The types of numbers that arrays in files are made of.
#pragma once

#include <cstddef>

namespace vdbtet {

enum class NumberType { Float32, Float64, Int32, Int64, UInt8 };

constexpr std::size_t bytesOf(NumberType type) {
    switch (type) {
    case NumberType::UInt8:
        return 1;
    case NumberType::Float32:
    case NumberType::Int32:
        return 4;
    case NumberType::Float64:
    case NumberType::Int64:
        break;
    }
    return 8;
}

} // namespace vdbtet
