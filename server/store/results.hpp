#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/lab/run.hpp"
#include "server/store/database.hpp"

namespace kinectlab::store {

struct StoredResult {
    lab::RunId run = 0;
    int version = 0;  ///< 1 for the first analysis of a run; a later one never overwrites it
    TimeNs created = 0;
    std::string result_json;  ///< the project's result object, provenance included
    std::string fit_json;     ///< {"objects": [{"object", "t_s", "measured", "fit", "residual"}]}
    std::string plots_json = "[]";  ///< as experiments::Evaluation has them
    std::vector<std::string> warnings;
    std::optional<lab::UserId> person;  ///< who had it made again; none for the run's own
};

class ResultRepository {
public:
    explicit ResultRepository(Database& database) : database_(database) {}

    /// Returns the version that it got; `result.version` is not looked at.
    int add(const StoredResult& result);
    [[nodiscard]] std::optional<StoredResult> latest(lab::RunId run);
    [[nodiscard]] std::optional<StoredResult> find(lab::RunId run, int version);
    /// All of a run in the order in which they were made, without their fits and plots.
    [[nodiscard]] std::vector<StoredResult> versions(lab::RunId run);

private:
    Database& database_;
};

}  // namespace kinectlab::store
