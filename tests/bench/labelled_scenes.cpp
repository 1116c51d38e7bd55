#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "tests/bench/measurements.hpp"
#include "tests/unit/pipeline/support/osd_frame.hpp"

namespace kinectlab::bench {

/// Nothing where the real frames are not there (KINECTLAB_SHARED_DATA or ../shared/data).
Figures measure_labelled_scenes() {
    namespace fs = std::filesystem;
    const char* given = std::getenv("KINECTLAB_SHARED_DATA");
    const fs::path folder =
        (given != nullptr ? fs::path(given) : fs::path("../shared/data")) / "pcl";
    std::error_code absent;
    int frames = 0;
    double worst_precision = 1.0, worst_table = 1.0, precision = 0.0, table = 0.0, objects = 0.0;
    for (const auto& entry : fs::directory_iterator(folder, absent)) {
        if (!entry.path().filename().string().starts_with("osd_")) continue;
        const auto osd = test::osd_frame(entry.path());
        if (!osd) continue;
        auto detector = ShapeDetector::create(osd->camera).value();
        const auto agrees = test::agreement(*osd, detector.detect(osd->frame.depth));
        ++frames;
        precision += agrees.precision();
        table += agrees.recall_of_table();
        objects += agrees.recall_of_objects();
        worst_precision = std::min(worst_precision, agrees.precision());
        worst_table = std::min(worst_table, agrees.recall_of_table());
    }
    if (frames == 0) return {};
    const std::string name = "real labelled scenes, shapes";
    return {
        {name + ", precision of points", precision / frames, "1", {}, Better::higher},
        {name + ", precision in the worst frame", worst_precision, "1", {}, Better::higher},
        {name + ", recall of the table", table / frames, "1", {}, Better::higher},
        {name + ", recall of the table in the worst frame", worst_table, "1", {}, Better::higher},
        {name + ", recall of the objects", objects / frames, "1", {}, Better::higher}};
}

}  // namespace kinectlab::bench
