// Requested keys and their values: the refusal of unknown keys, and the resolved tree.

#include <fmt/format.h>

#include <cctype>

#include "coast/config/node.hpp"
#include "tree.hpp"

namespace coast::config {

namespace {

void refuse(const TreeData& data, std::size_t index) {
  const TreeEntry& e = data.entries[index];
  for (std::size_t i : e.children) {
    const TreeEntry& child = data.entries[i];
    if (e.kind == Kind::kMap && !child.asked) {
      const std::vector<std::string> known(e.asked_keys.begin(), e.asked_keys.end());
      const std::string near = nearest(child.key, known);
      const std::string expected = !near.empty()   ? fmt::format("'{}' (the nearest known key)", near)
                                   : known.empty() ? "nothing: this run uses no key here"
                                                   : fmt::format("one of {}", fmt::join(known, ", "));
      throw data.error(i, "unknown key", expected, "Correct or remove it.");
    }
    refuse(data, i);
  }
}

std::string scalar(const TreeData& data, std::size_t index) {
  const TreeEntry& e = data.entries[index];
  if (e.kind == Kind::kNull) return "null";
  const bool portable = e.text.rfind("${COAST_DATA}", 0) == 0;
  return yaml_text(e.is_path && !portable ? resolve_path(data, index).string() : e.text);
}

bool is_flat(const TreeData& data, std::size_t index) {
  const TreeEntry& e = data.entries[index];
  if (e.kind == Kind::kMap) return false;
  for (std::size_t i : e.children) {
    if (!is_flat(data, i)) return false;
  }
  return true;
}

std::string flow(const TreeData& data, std::size_t index) {
  const TreeEntry& e = data.entries[index];
  if (e.kind != Kind::kList) return scalar(data, index);
  std::vector<std::string> parts;
  for (std::size_t i : e.children) parts.push_back(flow(data, i));
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

class Writer {
 public:
  explicit Writer(const TreeData& data) : data_(data) {}

  void map(std::size_t index, const std::string& indent) {
    const TreeEntry& e = data_.entries[index];
    for (std::size_t i : e.children) {
      const TreeEntry& child = data_.entries[i];
      value(i, indent + yaml_text(child.key) + ":", indent);
    }
    for (const auto& [key, text] : e.defaults) {
      if (data_.child(index, key) == nullptr) line(indent, key, text, "default");
    }
    // As comments: a run that starts from the estimates of another one would take another path and end with similar values.
    for (const auto& [key, text] : e.estimated) line(indent + "# ", key, text, "estimated");
  }

  void list(std::size_t index, const std::string& indent) {
    for (std::size_t i : data_.entries[index].children) {
      const std::size_t start = out_.size();
      if (data_.entries[i].kind == Kind::kMap) map(i, indent + "  ");
      if (out_.size() == start) {
        value(i, indent + "-", indent);
      } else {
        out_[start + indent.size()] = '-';
      }
    }
  }

  [[nodiscard]] const std::string& result() const { return out_; }

 private:
  void line(const std::string& indent, const std::string& key, const std::string& text, const std::string& origin) {
    out_ += fmt::format("{}{}: {}  # {}\n", indent, yaml_text(key), text, origin);
  }

  void value(std::size_t index, const std::string& head, const std::string& indent) {
    const TreeEntry& e = data_.entries[index];
    if (is_flat(data_, index)) {
      out_ += fmt::format("{} {}  # {}\n", head, flow(data_, index), data_.source_of(index));
    } else if (e.children.empty() && e.defaults.empty() && e.estimated.empty()) {
      if (e.line > 0) out_ += head + " {}\n";  // else an absent section without default
    } else {
      out_ += head + "\n";
      e.kind == Kind::kMap ? map(index, indent + "  ") : list(index, indent + "  ");
    }
  }

  const TreeData& data_;
  std::string out_;
};

bool is_plain(std::string_view text) {
  constexpr std::string_view kInside = "_./+-^()";
  if (text.empty() || text == "null" || text == "Null" || text == "NULL") return false;
  const auto alnum = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (char c : text) {
    if (!alnum(c) && kInside.find(c) == std::string_view::npos) return false;
  }
  if (text.front() == '-') return text.size() > 1 && (alnum(text[1]) || text[1] == '.');
  return alnum(text.front()) || kInside.find(text.front()) != std::string_view::npos;
}

}  // namespace

std::string yaml_text(std::string_view text) {
  if (is_plain(text)) return std::string(text);
  std::string quoted = "\"";
  for (char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      quoted += fmt::format("\\x{:02x}", byte);
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string yaml_text(double value) {
  return fmt::format("{}", value);
}

std::string yaml_text(const Eigen::Vector3d& value) {
  return fmt::format("[{}, {}, {}]", value.x(), value.y(), value.z());
}

void Node::refuse_unasked() const {
  refuse(*data_, index_);
}

std::string Node::resolved_yaml() const {
  Writer writer(*data_);
  const Kind kind = data_->entries[index_].kind;
  if (kind == Kind::kMap) writer.map(index_, "");
  if (kind == Kind::kList) writer.list(index_, "");
  if (kind == Kind::kScalar || kind == Kind::kNull) return scalar(*data_, index_) + "\n";
  return writer.result();
}

}  // namespace coast::config
