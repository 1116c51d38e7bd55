#include "server/experiments/definition_parts_json.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "server/experiments/analysis_choice_json.hpp"
#include "server/experiments/definition_names.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 4> kSteps{"stop", "clear", "displace", "wait"};

Result<SequenceStep> read_step(
    const json& element, const std::string& path, const Definition& definition
) {
    ObjectReader reader(element, path, {"do", "to", "seconds", "learn"});
    const std::string name = reader.text("do");
    if (!reader.ok()) return reader.error();
    const auto* const found = std::find(kSteps.begin(), kSteps.end(), name);
    if (found == kSteps.end()) return not_among(path + ".do", name, {kSteps.begin(), kSteps.end()});
    SequenceStep step;
    step.kind = static_cast<SequenceStep::Kind>(found - kSteps.begin());
    step.learn = reader.flag_or("learn", false);
    const bool waits = step.kind == SequenceStep::Kind::wait;
    const bool moves = step.kind == SequenceStep::Kind::displace;
    if (waits) step.seconds = reader.number("seconds");
    if (waits && !(step.seconds > 0.0 && step.seconds <= 60.0))
        reader.refuse("seconds", "is not from 0 to 60", "give a time in that range");
    if (!waits && reader.has("seconds"))
        reader.refuse("seconds", "belongs to the step wait only", "leave it out");
    if (!moves && reader.has("to"))
        reader.refuse("to", "belongs to the step displace only", "leave it out");
    if (moves && !reader.has("to"))
        reader.refuse("to", "is missing", "say where to, a number or {\"parameter\": NAME}");
    if (!reader.ok()) return reader.error();
    if (moves) {
        auto to = read_setting(element["to"], path + ".to", definition);
        if (!to) return tl::unexpected(to.error());
        step.to = std::move(*to);
    }
    return step;
}

Result<void> read_sequence(const json& document, Definition& definition) {
    const json& steps = document.contains("sequence") ? document["sequence"] : json::array();
    if (!steps.is_array())
        return fail(ErrorCode::invalid_argument, "sequence", "is no list", "give a list of steps");
    for (std::size_t i = 0; i < steps.size(); ++i) {
        auto step = read_step(steps[i], element_of("sequence", i), definition);
        if (!step) return tl::unexpected(step.error());
        definition.sequence.push_back(std::move(*step));
    }
    const auto learns = [](const SequenceStep& step) {
        return step.learn;
    };
    if (std::any_of(definition.sequence.begin(), definition.sequence.end(), learns)) return {};
    return fail(
        ErrorCode::invalid_argument,
        "sequence",
        "never learns the scene without objects",
        "put {\"do\": \"wait\", \"seconds\": 1, \"learn\": true} where no object is in view"
    );
}

Result<void> read_duration(const json& document, Definition& definition) {
    if (!document.contains("duration_s"))
        return fail(
            ErrorCode::invalid_argument,
            "duration_s",
            "is missing",
            "give seconds, or {\"parameter\": NAME}"
        );
    auto duration = read_setting(document["duration_s"], "duration_s", definition);
    if (!duration) return tl::unexpected(duration.error());
    definition.duration = std::move(*duration);
    const bool wrong = !definition.duration.parameter &&
                       !(definition.duration.number > 0.0 && definition.duration.number <= 3600.0);
    if (wrong)
        return fail(
            ErrorCode::invalid_argument,
            "duration_s",
            fmt::format("is {}", definition.duration.number),
            "give seconds from 0 to 3600"
        );
    if (!document.contains("early_end")) return {};
    ObjectReader reader(document["early_end"], "early_end", {"lost_s", "still_s"});
    definition.early_end.lost_s = reader.optional_number("lost_s");
    definition.early_end.still_s = reader.optional_number("still_s");
    for (const auto& [key, seconds] :
         {std::pair("lost_s", definition.early_end.lost_s),
          std::pair("still_s", definition.early_end.still_s)})
        if (seconds && !(*seconds >= 0.2 && *seconds <= 60.0))
            reader.refuse(key, fmt::format("is {}", *seconds), "give seconds from 0.2 to 60");
    if (!reader.ok()) return reader.error();
    return {};
}

json optional(const std::optional<double>& value) {
    return value ? json(*value) : json();
}

}  // namespace

Result<void> read_parts(const json& document, Definition& definition) {
    return read_sequence(document, definition)
        .and_then([&] { return read_duration(document, definition); })
        .and_then([&] { return read_analysis_choice(document, definition); });
}

void write_parts(const Definition& definition, json& document) {
    json& sequence = document["sequence"] = json::array();
    for (const auto& step : definition.sequence) {
        json element = {{"do", kSteps[static_cast<std::size_t>(step.kind)]}};
        if (step.kind == SequenceStep::Kind::displace) element["to"] = setting_json(step.to);
        if (step.kind == SequenceStep::Kind::wait) element["seconds"] = step.seconds;
        if (step.learn) element["learn"] = true;
        sequence.push_back(std::move(element));
    }
    document["duration_s"] = setting_json(definition.duration);
    if (definition.early_end.lost_s || definition.early_end.still_s)
        document["early_end"] = {
            {"lost_s", optional(definition.early_end.lost_s)},
            {"still_s", optional(definition.early_end.still_s)}};
    write_analysis_choice(definition, document);
}

}  // namespace kinectlab::experiments
