// OpenNI2 unloads its drivers at shutdown and forgets to free some of what it and they hold. Kept
// mapped, theirs stays reachable; its own is named. Leaks of our drivers are still reported.
// Fontconfig keeps its patterns to the process' end, and which ones depends on the fonts there are.
#include <filesystem>

#include <dlfcn.h>
#include <gtest/gtest.h>

extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libOpenNI2.so\nleak:libPS1080.so\nleak:libPSLink.so\nleak:libOniFile.so\n"
           "leak:libfontconfig.so\n";
}

namespace {

class KeepDriversMapped : public testing::Environment {
public:
    void SetUp() override {
        namespace fs = std::filesystem;
        const fs::path bin = fs::read_symlink("/proc/self/exe").parent_path();
        for (const auto& entry : fs::directory_iterator(bin / "../lib/openni2/OpenNI2/Drivers"))
            dlopen(entry.path().c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    }
};

const auto* const kEnvironment = testing::AddGlobalTestEnvironment(new KeepDriversMapped);

}  // namespace
