#include "tests/fuzz/mutation.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace kinectlab::fuzz {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kLargest = 65536;

// What readers stumble over: signs, sizes beyond any memory, numbers that are none, half a syntax.
constexpr std::array kWords{
    "-1"sv,
    "0"sv,
    "4294967295"sv,
    "18446744073709551615"sv,
    "9223372036854775808"sv,
    "1e308"sv,
    "nan"sv,
    "inf"sv,
    "-inf"sv,
    "99999999"sv,
    "\n"sv,
    " "sv,
    "{"sv,
    "}"sv,
    "[]"sv,
    "null"sv,
    "\""sv,
    "#"sv,
    "\0\0\0\0"sv,
    "\xff\xff\xff\xff"sv,
    "\x7f\xf0"sv,
    "../../etc/passwd"sv,
};

class Mutator {
public:
    explicit Mutator(std::mt19937_64& random) : random_(random) {}

    void change(Bytes& bytes, const Bytes& other) {
        const std::size_t at = below(bytes.size() + 1);
        const auto here = bytes.begin() + static_cast<std::ptrdiff_t>(at);
        const std::size_t length = std::min(below(32), bytes.size() - at);
        const auto there = here + static_cast<std::ptrdiff_t>(length);
        switch (below(8)) {
            case 0:
                if (at < bytes.size()) bytes[at] ^= static_cast<std::uint8_t>(1U << below(8));
                break;
            case 1:
                if (at < bytes.size()) bytes[at] = static_cast<std::uint8_t>(below(256));
                break;
            case 2:
                bytes.erase(here, there);
                break;
            case 3: {
                const Bytes piece(here, there);
                bytes.insert(here, piece.begin(), piece.end());
                break;
            }
            case 4: {
                const std::size_t from = below(other.size() + 1);
                const std::size_t count = std::min(below(64), other.size() - from);
                const auto first = other.begin() + static_cast<std::ptrdiff_t>(from);
                bytes.insert(here, first, first + static_cast<std::ptrdiff_t>(count));
                break;
            }
            case 5:
                put(bytes, at, number_at(bytes, at), word());
                break;
            case 6:
                put(bytes, at, 0, word());
                break;
            default:
                if (below(4) == 0) bytes.resize(at);
        }
        if (bytes.size() > kLargest) bytes.resize(kLargest);
    }

private:
    std::size_t below(std::size_t limit) { return limit == 0 ? 0 : random_() % limit; }
    std::string_view word() { return kWords[below(kWords.size())]; }

    static std::size_t number_at(const Bytes& bytes, std::size_t at) {
        std::size_t end = at;
        while (end < bytes.size() && (bytes[end] == '.' || (bytes[end] >= '0' && bytes[end] <= '9'))
        )
            ++end;
        return end - at;
    }

    static void put(Bytes& bytes, std::size_t at, std::size_t length, std::string_view text) {
        const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at);
        const auto here = bytes.erase(first, first + static_cast<std::ptrdiff_t>(length));
        bytes.insert(here, text.begin(), text.end());
    }

    std::mt19937_64& random_;
};

}  // namespace

Bytes mutated(const Bytes& input, const Bytes& other, std::mt19937_64& random) {
    Bytes bytes = input;
    Mutator mutator(random);
    for (std::uint64_t changes = 1 + random() % 8; changes > 0; --changes)
        mutator.change(bytes, other);
    return bytes;
}

}  // namespace kinectlab::fuzz
