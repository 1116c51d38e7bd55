#pragma once

#include <cstring>
#include <string_view>
#include <type_traits>

#include "pipeline/drivers/simulated_rig/openni_driver.hpp"

namespace kinectlab::simulated_rig {

/// Writes a plain value into the program's buffer, which has to be of just that size.
template <class T>
OniStatus give(const T& value, void* data, int* size) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (data == nullptr || size == nullptr || *size != static_cast<int>(sizeof(T)))
        return ONI_STATUS_BAD_PARAMETER;
    std::memcpy(data, &value, sizeof(T));
    return ONI_STATUS_OK;
}

/// A text with its closing zero; the buffer may be larger.
inline OniStatus give_text(std::string_view text, void* data, int* size) {
    const int needed = static_cast<int>(text.size()) + 1;
    if (data == nullptr || size == nullptr || *size < needed) return ONI_STATUS_BAD_PARAMETER;
    std::memcpy(data, text.data(), text.size());
    static_cast<char*>(data)[text.size()] = '\0';
    *size = needed;
    return ONI_STATUS_OK;
}

/// Reads a plain value; false if the program's buffer is of another size.
template <class T>
bool take(T& value, const void* data, int size) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (data == nullptr || size != static_cast<int>(sizeof(T))) return false;
    std::memcpy(&value, data, sizeof(T));
    return true;
}

}  // namespace kinectlab::simulated_rig
