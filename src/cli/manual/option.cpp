#include "option.hpp"

#include <sstream>

namespace coast::cli {

std::vector<std::string> spellings(const CLI::Option& option) {
  std::vector<std::string> all;
  for (const std::string& name : option.get_snames()) all.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) all.push_back("--" + name);
  return all;
}

std::string value_name(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

std::vector<std::string> choices(const CLI::Option& option) {
  const std::string type = value_name(option);
  if (type.find('|') == std::string::npos) return {};
  std::vector<std::string> all;
  std::istringstream words(type);
  for (std::string word; std::getline(words, word, '|');) all.push_back(word);
  return all;
}

}  // namespace coast::cli
