#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/lab/people.hpp"
#include "server/store/database.hpp"

namespace kinectlab::store {

/// One version of an experiment that an instructor made.
struct StoredDefinition {
    std::string experiment;
    int version = 1;
    lab::UserId owner = 0;
    std::string owner_name;
    std::string definition_json;
    TimeNs created = 0;
    std::optional<TimeNs> published;  ///< none: a draft
    std::optional<TimeNs> retired;    ///< offered no longer
};

/// Experiments beside those that the program brings. A published version never changes.
class DefinitionRepository {
public:
    explicit DefinitionRepository(Database& database) : database_(database) {}

    /// Newest version of each experiment first by name; `experiment` limits it to one.
    [[nodiscard]] std::vector<StoredDefinition> all(
        const std::optional<std::string>& experiment = {}
    );

    /// Replaces the experiment's draft, or begins its next version.
    StoredDefinition put_draft(
        const std::string& experiment, lab::UserId owner, const std::string& json, TimeNs now
    );
    /// The draft becomes the version that is offered; false if there is none.
    bool publish(const std::string& experiment, TimeNs now);
    /// Takes the draft away and offers the experiment no longer; false if there was nothing to do.
    bool retire(const std::string& experiment, TimeNs now);

private:
    Database& database_;
};

}  // namespace kinectlab::store
