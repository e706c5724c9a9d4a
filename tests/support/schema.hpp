#pragma once
// Files against the schemas of docs/schema, by valijson: no code shared with the readers and writers.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace coast::test {

/// What the schema docs/schema/<name>.schema.json does not allow, one line each; empty where the document is valid.
[[nodiscard]] std::vector<std::string> schema_violations(const std::string& name, const nlohmann::json& document);

/// Fails, with what is not allowed, unless the document is valid.
void expect_valid(const std::string& name, const nlohmann::json& document, const std::string& what = "");

/// The schema itself, as JSON.
[[nodiscard]] nlohmann::json schema(const std::string& name);

/// The name of the schema that a document says it follows ("schema: coast.run/1" gives "run"); "run" where it says nothing.
[[nodiscard]] std::string schema_of(const nlohmann::json& document);

/// YAML as JSON: plain numbers, true, false and null by YAML's core schema, everything else as text.
[[nodiscard]] nlohmann::json yaml_as_json(const std::string& yaml);
[[nodiscard]] nlohmann::json load_yaml_as_json(const std::filesystem::path& file);

}  // namespace coast::test
