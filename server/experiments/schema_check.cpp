#include "server/experiments/schema_check.hpp"

#include <stdexcept>

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "server/experiments/share_dir.hpp"
#include "server/experiments/strict_json.hpp"

namespace kinectlab::experiments {
namespace {

std::unique_ptr<valijson::Schema> load_schema() {
    const auto document =
        read_json_file(share_dir() / "experiments" / "schema" / "experiment.schema.json");
    if (!document) throw std::runtime_error(to_text(document.error()));
    auto schema = std::make_unique<valijson::Schema>();
    valijson::SchemaParser parser;
    const valijson::adapters::NlohmannJsonAdapter adapter(*document);
    parser.populateSchema(adapter, *schema);
    return schema;
}

}  // namespace

Result<void> check_schema(const nlohmann::json& definition) {
    static const auto kSchema = load_schema();
    valijson::Validator validator;
    valijson::ValidationResults results;
    const valijson::adapters::NlohmannJsonAdapter target(definition);
    if (validator.validate(*kSchema, target, &results)) return {};
    // The innermost place stands last: what is around it fails only because of it.
    valijson::ValidationResults::Error error;
    valijson::ValidationResults::Error next;
    while (results.popError(next))
        if (next.context.size() >= error.context.size()) error = next;
    std::string path;
    for (std::size_t i = 1; i < error.context.size(); ++i)
        path += error.context[i];
    return fail(
        ErrorCode::invalid_argument,
        path,
        "does not fit the schema: " + error.description,
        "see the schema of experiments"
    );
}

}  // namespace kinectlab::experiments
