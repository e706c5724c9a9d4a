#include "support/schema.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace coast::test {

namespace {

using nlohmann::json;

json scalar(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;  // in quotes
  if (text == "true" || text == "false") return text == "true";
  long whole = 0;
  const char* end = text.data() + text.size();
  if (const auto r = std::from_chars(text.data(), end, whole); r.ec == std::errc() && r.ptr == end) return whole;
  double number = 0.0;
  if (const auto r = std::from_chars(text.data(), end, number); r.ec == std::errc() && r.ptr == end) return number;
  return text;
}

json convert(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return scalar(node);
    case YAML::NodeType::Sequence: {
      json list = json::array();
      for (const auto& item : node) list.push_back(convert(item));
      return list;
    }
    case YAML::NodeType::Map: {
      json map = json::object();
      for (const auto& item : node) map[item.first.Scalar()] = convert(item.second);
      return map;
    }
    default:
      return nullptr;
  }
}

}  // namespace

json schema(const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(COAST_SOURCE_DIR) / "docs" / "schema" / (name + ".schema.json");
  std::ifstream in(file);
  if (!in) throw std::runtime_error("no schema " + file.string());
  return json::parse(in);
}

std::vector<std::string> schema_violations(const std::string& name, const json& document) {
  const json text = schema(name);
  valijson::Schema parsed;
  valijson::SchemaParser parser;
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(text), parsed);
  valijson::Validator validator;
  valijson::ValidationResults results;
  validator.validate(parsed, valijson::adapters::NlohmannJsonAdapter(document), &results);
  std::vector<std::string> lines;
  for (const auto& error : results) {
    std::string line;
    for (const std::string& step : error.context) line += step;
    lines.push_back(line + ": " + error.description);
  }
  return lines;
}

void expect_valid(const std::string& name, const json& document, const std::string& what) {
  std::string all;
  for (const std::string& line : schema_violations(name, document)) all += "\n  " + line;
  EXPECT_TRUE(all.empty()) << what << " against the schema " << name << ":" << all;
}

std::string schema_of(const json& document) {
  const std::string id = document.value("schema", "coast.run/1");
  const std::size_t dot = id.find('.') + 1;
  return id.substr(dot, id.rfind('/') - dot);
}

json yaml_as_json(const std::string& yaml) {
  return convert(YAML::Load(yaml));
}

json load_yaml_as_json(const std::filesystem::path& file) {
  return convert(YAML::LoadFile(file.string()));
}

}  // namespace coast::test
