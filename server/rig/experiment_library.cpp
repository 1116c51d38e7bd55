#include "server/rig/experiment_library.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace kinectlab::rig {
namespace {

DefinitionState state_of(const store::StoredDefinition& stored) {
    if (!stored.published) return DefinitionState::draft;
    return stored.retired ? DefinitionState::retired : DefinitionState::published;
}

/// None where a later program cannot read what an earlier one let pass.
std::optional<LibraryEntry> to_entry(const store::StoredDefinition& stored) {
    auto definition =
        experiments::read_definition(nlohmann::json::parse(stored.definition_json, nullptr, false));
    if (!definition) return std::nullopt;
    return LibraryEntry{
        std::move(*definition), state_of(stored), stored.version, stored.owner, stored.owner_name};
}

bool plain_name(const std::string& id) {
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    return !id.empty() && id.size() <= 64 && std::all_of(id.begin(), id.end(), fits);
}

}  // namespace

std::string_view to_text(DefinitionState state) {
    constexpr std::array<std::string_view, 4> kNames{"built-in", "published", "draft", "retired"};
    return kNames.at(static_cast<std::size_t>(state));
}

std::vector<LibraryEntry> ExperimentLibrary::list(const lab::User& user) const {
    std::vector<LibraryEntry> entries;
    for (const auto& definition : built_in_)
        entries.push_back({definition, DefinitionState::built_in, {}, {}, {}});
    std::string offered;  // its newest published version has been listed
    for (const auto& stored : stored_.all()) {
        const bool own = stored.owner == user.id || lab::at_least(user.role, lab::Role::admin);
        const DefinitionState state = state_of(stored);
        if (state != DefinitionState::draft) {
            if (offered == stored.experiment) continue;
            offered = stored.experiment;
        }
        if (state != DefinitionState::published && !own) continue;
        if (auto entry = to_entry(stored)) entries.push_back(std::move(*entry));
    }
    return entries;
}

std::optional<experiments::Definition> ExperimentLibrary::offered(const std::string& id) const {
    for (const auto& definition : built_in_)
        if (definition.id == id) return definition;
    for (const auto& stored : stored_.all(id)) {
        const DefinitionState state = state_of(stored);
        if (state == DefinitionState::draft) continue;
        if (state == DefinitionState::retired) return std::nullopt;
        if (auto entry = to_entry(stored)) return std::move(entry->definition);
    }
    return std::nullopt;
}

std::vector<experiments::Definition> ExperimentLibrary::all_offered() const {
    std::vector<experiments::Definition> all = built_in_;
    std::string decided;  // the newest version that is no draft says whether it is offered
    for (const auto& stored : stored_.all()) {
        const DefinitionState state = state_of(stored);
        if (state == DefinitionState::draft || stored.experiment == decided) continue;
        decided = stored.experiment;
        if (state != DefinitionState::published) continue;
        if (auto entry = to_entry(stored)) all.push_back(std::move(entry->definition));
    }
    return all;
}

Result<void> ExperimentLibrary::may_change(const lab::User& user, const std::string& id) const {
    if (!lab::at_least(user.role, lab::Role::instructor))
        return fail(ErrorCode::forbidden, "", "only instructors make experiments");
    for (const auto& definition : built_in_)
        if (definition.id == id)
            return fail(
                ErrorCode::conflict,
                "definition.id",
                "\"" + id + "\" comes with the program",
                "give the copy an id of its own"
            );
    const auto versions = stored_.all(id);
    const bool own = versions.empty() || versions.front().owner == user.id ||
                     lab::at_least(user.role, lab::Role::admin);
    if (own) return {};
    return fail(
        ErrorCode::forbidden,
        "definition.id",
        "\"" + id + "\" is " + versions.front().owner_name + "'s",
        "copy it under an id of your own"
    );
}

Result<LibraryEntry> ExperimentLibrary::save(
    const lab::User& user, const experiments::Definition& definition, TimeNs now
) {
    if (!plain_name(definition.id))
        return fail(
            ErrorCode::invalid_argument,
            "definition.id",
            "is \"" + definition.id.substr(0, 40) + "\"",
            "use 1 to 64 small letters, digits, - and _"
        );
    if (auto ok = may_change(user, definition.id); !ok) return tl::unexpected(ok.error());
    const auto stored =
        stored_.put_draft(definition.id, user.id, experiments::to_json(definition).dump(), now);
    return LibraryEntry{
        definition, state_of(stored), stored.version, stored.owner, stored.owner_name};
}

Result<void> ExperimentLibrary::publish(const lab::User& user, const std::string& id, TimeNs now) {
    if (auto ok = may_change(user, id); !ok) return ok;
    if (stored_.all(id).empty())
        return fail(ErrorCode::not_found, "experiment", "there is no \"" + id.substr(0, 40) + "\"");
    if (stored_.publish(id, now)) return {};
    return fail(
        ErrorCode::conflict, "experiment", "has no draft to publish", "save a change first"
    );
}

Result<void> ExperimentLibrary::retire(const lab::User& user, const std::string& id, TimeNs now) {
    if (auto ok = may_change(user, id); !ok) return ok;
    if (stored_.all(id).empty())
        return fail(ErrorCode::not_found, "experiment", "there is no \"" + id.substr(0, 40) + "\"");
    if (stored_.retire(id, now)) return {};
    return fail(ErrorCode::conflict, "experiment", "is retired already");
}

}  // namespace kinectlab::rig
