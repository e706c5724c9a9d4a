#include "tree.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>

#include "coast/config/builder.hpp"
#include "coast/io/yaml.hpp"
#include "coast/jobs/file_kind.hpp"
#include "coast/record/table.hpp"

namespace coast::python {

namespace py = pybind11;

namespace {

constexpr long kNoLine = 0;

std::shared_ptr<const record::Table> table_from(const py::handle& object) {
  auto table = std::make_shared<record::Table>();
  table->name = object.attr("name").cast<std::string>();
  for (const py::handle& column : object.attr("columns").cast<py::dict>().attr("items")()) {
    const auto [name, values] =
        column.cast<std::pair<std::string, py::array_t<double, py::array::c_style | py::array::forcecast>>>();
    table->header.push_back(name);
    table->columns.emplace_back(values.data(), values.data() + values.size());
  }
  return table;
}

/// A scalar of Python or numpy as the text that YAML would have for it.
std::string text_of(const py::handle& value) {
  if (py::hasattr(value, "item")) return text_of(value.attr("item")());
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::float_>(value)) return fmt::format("{}", value.cast<double>());
  return py::str(value);
}

bool is_list(const py::handle& value) {
  return py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value) || py::isinstance<py::array>(value);
}

class Builder {
 public:
  explicit Builder(const std::filesystem::path& name) : builder_(name) {}

  config::Node build(const py::dict& root) {
    const auto id = builder_.root_map(kNoLine);
    add_items(id, root);
    return builder_.finish();
  }

 private:
  using Id = config::TreeBuilder::Id;

  void add_items(Id parent, const py::dict& map) {
    for (const auto& [key, value] : map) add(parent, py::str(key), value);
  }

  void add(Id parent, std::string key, const py::handle& value) {
    if (py::isinstance<py::dict>(value)) {
      add_items(builder_.add_map(parent, std::move(key), kNoLine), value.cast<py::dict>());
    } else if (is_list(value)) {
      const Id list = builder_.add_list(parent, std::move(key), kNoLine);
      for (const py::handle& item : value) add(list, "", item);
    } else if (value.is_none()) {
      builder_.add_null(parent, std::move(key), kNoLine);
    } else if (py::hasattr(value, "coast_table")) {
      builder_.add_table(parent, std::move(key), table_from(value));
    } else {
      builder_.add_scalar(parent, std::move(key), text_of(value), kNoLine);
    }
  }

  config::TreeBuilder builder_;
};

}  // namespace

config::Node tree_from(const py::object& config, const std::string& folder) {
  return py::isinstance<py::dict>(config) ? Builder(std::filesystem::path(folder) / "dict").build(config.cast<py::dict>())
                                          : io::load_yaml(config.cast<std::filesystem::path>());
}

config::Node tree_from(const py::object& config, const std::string& folder, std::string_view command) {
  config::Node root = tree_from(config, folder);
  jobs::require_kind(root, command);
  return root;
}

}  // namespace coast::python
