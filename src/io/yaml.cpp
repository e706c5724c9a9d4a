#include "coast/io/yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>

#include "coast/config/builder.hpp"
#include "coast/io/input.hpp"
#include "file_kind.hpp"

namespace coast::io {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{16} << 20;
constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxNodes = 200'000;

// Builds the tree from the parser's events. Events instead of yaml-cpp's own nodes: those silently keep one of two equal keys
// and expand aliases without bound.
class TreeHandler final : public YAML::EventHandler {
 public:
  explicit TreeHandler(const std::string& name) : name_(name), builder_(name) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (has_root_) refuse(mark, "a second document", "one document", "Put it into a file of its own.");
    // At a stray ',' or ']' the parser returns empty documents for ever, without advancing.
    if (++documents_ > 1) refuse(mark, "text that belongs to no key", "keys with values ('key: value')");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    if (open_.empty()) return;  // an empty document, or only comments
    if (awaits_key()) refuse(mark, "an empty key", "the name of a key");
    builder_.add_null(parent(mark), take_key(), line(mark));
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(mark, "an alias ('*name')", "a value", "Aliases are not supported: write the value out.");
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string& value) override {
    check_tag(mark, tag);
    if (open_.empty()) refuse(mark, fmt::format("'{}'", value.substr(0, 40)), "keys with values ('key: value')");
    if (awaits_key()) {
      set_key(mark, value);
    } else {
      builder_.add_scalar(parent(mark), take_key(), value, line(mark));
    }
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, YAML::EmitterStyle::value) override {
    check_tag(mark, tag);
    if (open_.empty()) refuse(mark, "a list", "a map of keys at the top of the file");
    if (awaits_key()) refuse(mark, "a list as a key", "the name of a key");
    const auto id = builder_.add_list(parent(mark), take_key(), line(mark));
    push(mark, {id, false, {}, {}});
  }
  void OnSequenceEnd() override { open_.pop_back(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, YAML::EmitterStyle::value) override {
    check_tag(mark, tag);
    if (awaits_key()) refuse(mark, "a map as a key", "the name of a key");
    const auto id = open_.empty() ? builder_.root_map(line(mark)) : builder_.add_map(parent(mark), take_key(), line(mark));
    has_root_ = true;
    push(mark, {id, true, {}, {}});
  }
  void OnMapEnd() override { open_.pop_back(); }

  [[nodiscard]] bool has_root() const { return has_root_; }
  [[nodiscard]] config::Node finish() { return builder_.finish(); }

 private:
  struct Level {
    config::TreeBuilder::Id id;
    bool is_map;
    std::optional<std::string> key;             // key waiting for its value
    std::map<std::string, long> lines_of_keys;  // for the message on a duplicate
  };

  [[nodiscard]] static long line(const YAML::Mark& mark) { return mark.line + 1; }
  [[nodiscard]] bool awaits_key() const { return !open_.empty() && open_.back().is_map && !open_.back().key; }

  [[noreturn]] void refuse(const YAML::Mark& mark, std::string found, std::string expected, std::string what_to_do = "") const {
    throw InputError({name_, line(mark), std::move(found), std::move(expected), std::move(what_to_do)});
  }

  void check_tag(const YAML::Mark& mark, const std::string& tag) const {
    const bool none = tag.empty() || tag == "?" || tag == "!";  // "?": plain, "!": in quotes
    if (!none) refuse(mark, fmt::format("the tag '{}'", tag), "a plain value", "Tags are not supported.");
  }

  config::TreeBuilder::Id parent(const YAML::Mark& mark) {
    if (++nodes_ > kMaxNodes) refuse(mark, fmt::format("more than {} values", kMaxNodes), "a configuration");
    return open_.back().id;
  }

  void push(const YAML::Mark& mark, Level level) {
    if (open_.size() >= kMaxDepth) refuse(mark, fmt::format("more than {} levels of nesting", kMaxDepth), "a configuration");
    open_.push_back(std::move(level));
  }

  void set_key(const YAML::Mark& mark, const std::string& key) {
    const auto [first, is_new] = open_.back().lines_of_keys.emplace(key, line(mark));
    if (!is_new) {
      refuse(mark, fmt::format("the key '{}' for the second time", key), "each key once",
             fmt::format("The first is at line {}.", first->second));
    }
    open_.back().key = key;
  }

  std::string take_key() {
    std::string key = std::move(open_.back().key).value_or("");
    open_.back().key.reset();
    return key;
  }

  std::string name_;
  config::TreeBuilder builder_;
  std::vector<Level> open_;
  std::size_t nodes_ = 0;
  int documents_ = 0;
  bool has_root_ = false;
};

void check_is_text(const std::string& text, const std::string& name) {
  const auto is_control = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 && c != '\t' && c != '\n' && c != '\r';
  };
  const auto bad = std::find_if(text.begin(), text.end(), is_control);
  if (bad == text.end()) return;
  throw InputError({name, std::count(text.begin(), bad, '\n') + 1,
                    fmt::format("the byte 0x{:02x}: binary data", static_cast<unsigned char>(*bad)), "a YAML text in UTF-8",
                    ""});
}

// The two mistakes that yaml-cpp's message does not name.
std::string hint(const std::string& text, long line) {
  std::istringstream lines(text);
  std::string current;
  for (long i = 0; i < line && std::getline(lines, current); ++i) {
  }
  const std::size_t first = current.find_first_not_of(" \t");
  if (current.substr(0, first).find('\t') != std::string::npos)
    return "The line is indented with a tab; YAML allows spaces only.";
  if (text.find("${") != std::string::npos) return "Inside { } and [ ] a path with ${COAST_DATA} is written in quotes.";
  return "";
}

}  // namespace

config::Node parse_yaml(const std::string& text, const std::string& name) {
  check_is_text(text, name);
  TreeHandler handler(name);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(handler)) {
    }
  } catch (const YAML::Exception& e) {
    const long line = e.mark.is_null() ? 0 : e.mark.line + 1;
    throw InputError({name, line, e.msg, "valid YAML", hint(text, line)});
  }
  if (!handler.has_root()) throw InputError({name, 0, "the file is empty", "keys with values ('key: value')", ""});
  return handler.finish();
}

config::Node load_yaml(const std::filesystem::path& path) {
  ByteSource source(path);
  std::string text(kMaxBytes + 1, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const std::size_t got = source.read(text.data() + size, text.size() - size);
    if (got == 0) break;
    size += got;
  }
  if (size > kMaxBytes) {
    refuse_other_kind(path, FileKind::Content::kYaml, "a configuration file");
    throw InputError({path.string(), 0, "more than 16 MiB", "a configuration file", "Is this a recording?"});
  }
  text.resize(size);
  // Some files of other kinds can be parsed as YAML, for example RINEX.
  if (const auto kind = file_kind(std::string_view(text).substr(0, 4096)); kind && is_no_table(kind->content))
    refuse_other_kind(path, FileKind::Content::kYaml, "a configuration file");
  try {
    return parse_yaml(text, path.string());
  } catch (const InputError&) {
    refuse_other_kind(path, FileKind::Content::kYaml, "a configuration file");
    throw;
  }
}

}  // namespace coast::io
