#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/experiments/definition.hpp"
#include "server/lab/people.hpp"
#include "server/store/definitions.hpp"

namespace kinectlab::rig {

enum class DefinitionState : std::uint8_t { built_in, published, draft, retired };

[[nodiscard]] std::string_view to_text(DefinitionState state);

/// A definition and where it stands.
struct LibraryEntry {
    experiments::Definition definition;
    DefinitionState state = DefinitionState::built_in;
    std::optional<int> version;  ///< none of a built-in one
    std::optional<lab::UserId> owner;
    std::string owner_name;
};

/// All experiments: those that the program brings and those that instructors published.
/// Thread-safe.
class ExperimentLibrary {
public:
    ExperimentLibrary(
        std::vector<experiments::Definition> built_in, store::DefinitionRepository& stored
    )
        : built_in_(std::move(built_in)), stored_(stored) {}

    /// What this person may see: all that are offered; of one's own (an administrator: of all) also
    /// the drafts and the retired.
    [[nodiscard]] std::vector<LibraryEntry> list(const lab::User& user) const;

    /// The version that runs are made with now; none for drafts and retired ones.
    [[nodiscard]] std::optional<experiments::Definition> offered(const std::string& id) const;

    /// All that are offered, the built-in ones first.
    [[nodiscard]] std::vector<experiments::Definition> all_offered() const;

    /// Stores a draft. Errors: forbidden (no instructor, somebody else's), conflict (a built-in
    /// one's id), invalid_argument (an id that is no plain name).
    [[nodiscard]] Result<LibraryEntry> save(
        const lab::User& user, const experiments::Definition& definition, TimeNs now
    );
    /// Errors of both: not_found, forbidden; conflict where there is no draft, or nothing to
    /// retire.
    [[nodiscard]] Result<void> publish(const lab::User& user, const std::string& id, TimeNs now);
    [[nodiscard]] Result<void> retire(const lab::User& user, const std::string& id, TimeNs now);

    [[nodiscard]] const std::vector<experiments::Definition>& built_in() const { return built_in_; }

private:
    [[nodiscard]] Result<void> may_change(const lab::User& user, const std::string& id) const;

    const std::vector<experiments::Definition> built_in_;
    store::DefinitionRepository& stored_;
};

}  // namespace kinectlab::rig
