#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include "tests/fuzz/targets.hpp"

// fuzz TARGET [RUNS [SEED]] reads damaged copies of sound files; under the sanitizers what goes
// wrong stops it. fuzz TARGET FILE reads one file, e.g. the one that stopped it.

namespace {

using namespace kinectlab::fuzz;

constexpr const char* kInput = "fuzz-input";

void keep(const Bytes& bytes) {
    std::ofstream file(kInput, std::ios::binary | std::ios::trunc);
    file.write(
        reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())
    );
}

int fuzz(const Target& target, std::uint64_t runs, std::uint64_t seed) {
    for (std::size_t i = 0; i < target.seeds.size(); ++i) {
        if (target.read(target.seeds[i])) continue;
        keep(target.seeds[i]);
        std::cerr << target.name << ": refuses sound file " << i << ", kept in " << kInput << '\n';
        return 1;
    }
    std::size_t taken = 0;
    for (std::uint64_t run = 0; run < runs; ++run) {
        std::mt19937_64 random(seed + run);
        const Bytes& base = target.seeds[random() % target.seeds.size()];
        const Bytes& other = target.seeds[random() % target.seeds.size()];
        const Bytes bytes = mutated(base, other, random);
        try {
            taken += target.read(bytes) ? 1 : 0;
        } catch (const std::exception& error) {
            keep(bytes);
            std::cerr << target.name << ": threw " << error.what() << " at seed " << seed + run
                      << "; the bytes are in " << kInput << '\n';
            return 1;
        }
    }
    std::cout << target.name << ": " << runs << " inputs, " << taken << " of them taken\n";
    return taken < runs ? 0 : 1;
}

int read_file(const Target& target, const char* name) {
    std::ifstream file(name, std::ios::binary);
    const Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    std::cout << (target.read(bytes) ? "taken" : "refused") << '\n';
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const auto targets = all_targets();
    const std::string name = argc > 1 ? argv[1] : "";
    for (const auto& target : targets) {
        if (target.name != name) continue;
        char* end = nullptr;
        const std::uint64_t runs = argc > 2 ? std::strtoull(argv[2], &end, 10) : 1000;
        if (end != nullptr && *end != '\0') return read_file(target, argv[2]);
        return fuzz(target, runs, argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1);
    }
    std::cerr << "fuzz TARGET [RUNS [SEED]] or fuzz TARGET FILE; targets:";
    for (const auto& target : targets)
        std::cerr << ' ' << target.name;
    std::cerr << '\n';
    return 2;
}
