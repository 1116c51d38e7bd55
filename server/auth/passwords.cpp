#include "server/auth/passwords.hpp"

#include <array>
#include <new>
#include <semaphore>

#include <sodium.h>

#include "server/auth/sodium.hpp"

namespace kinectlab::auth {
namespace {

constexpr std::size_t kMemoryBytes = 64U << 20U;
constexpr unsigned kPasses = 3;
constexpr std::size_t kShortest = 10;
constexpr std::size_t kLongest = 200;

constexpr std::array<std::string_view, 8> kTriedFirst{
    "1234567890",
    "0123456789",
    "password123",
    "passwordpassword",
    "qwertyuiop",
    "qwertzuiop",
    "letmeinplease",
    "kinectlab123"};

std::counting_semaphore<2>& slots() {
    static std::counting_semaphore<2> places{2};
    return places;
}

class Slot {
public:
    Slot() { slots().acquire(); }
    ~Slot() { slots().release(); }
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;
};

}  // namespace

std::string hash_password(std::string_view password) {
    need_sodium();
    const Slot slot;
    std::array<char, crypto_pwhash_STRBYTES> hash{};
    const int failed = crypto_pwhash_str_alg(
        hash.data(),
        password.data(),
        password.size(),
        kPasses,
        kMemoryBytes,
        crypto_pwhash_ALG_ARGON2ID13
    );
    if (failed != 0) throw std::bad_alloc();
    return hash.data();
}

bool verify_password(const std::string& hash, std::string_view password) {
    need_sodium();
    const Slot slot;
    return crypto_pwhash_str_verify(hash.c_str(), password.data(), password.size()) == 0;
}

void verify_against_nobody(std::string_view password) {
    static const std::string hash = hash_password(make_one_time_password());
    static_cast<void>(verify_password(hash, password));
}

Result<void> check_new_password(
    std::string_view password, std::string_view username, const std::string& field
) {
    const auto refuse = [&](std::string message, std::string cure) -> Result<void> {
        return fail(ErrorCode::invalid_argument, field, std::move(message), std::move(cure));
    };
    if (password.size() < kShortest) {
        return refuse(
            "is too short with " + std::to_string(password.size()) + " characters",
            "give at least 10; a few words in a row are easy to remember"
        );
    }
    if (password.size() > kLongest) return refuse("is too long", "give at most 200 characters");
    if (password.find(username) != std::string_view::npos && password.size() < 2 * kShortest) {
        return refuse("contains the user name", "choose one that cannot be guessed from it");
    }
    for (const auto known : kTriedFirst) {
        if (password == known) return refuse("is one that everybody tries first", "choose another");
    }
    return {};
}

std::string make_one_time_password() {
    need_sodium();
    constexpr std::string_view kAlphabet = "abcdefghijkmnpqrstuvwxyz23456789";
    static_assert(kAlphabet.size() == 32);
    std::string text;
    for (int i = 0; i < 16; ++i) {
        if (i > 0 && i % 4 == 0) text.push_back('-');
        text.push_back(kAlphabet[randombytes_uniform(kAlphabet.size())]);
    }
    return text;
}

}  // namespace kinectlab::auth
