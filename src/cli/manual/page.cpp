#include "page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "option.hpp"

namespace coast::cli {

namespace {

/// Text of a page: characters that roff takes for its own are written as what they look like.
std::string escaped(const std::string& text) {
  std::string safe;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) safe += "\\&";
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else if (c == '~')
      safe += "\\(ti";
    else if (c == '^')
      safe += "\\(ha";
    else if (c == '`')
      safe += "\\(ga";
    else
      safe += c;
    begins_line = c == '\n';
  }
  return safe;
}

std::string bold(const std::string& text) {
  return "\\fB" + escaped(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + escaped(text) + "\\fR";
}

std::string synopsis(const CLI::App& app) {
  std::string line = bold(app.get_parent() == nullptr ? app.get_name() : app.get_parent()->get_name() + " " + app.get_name());
  if (!subcommands(app).empty()) return line + " " + italic("subcommand") + " [" + italic("options") + "]";
  line += " [" + italic("options") + "]";
  for (const CLI::Option* one : options(app, true)) line += " " + italic(one->get_name(true));
  return line;
}

/// A tagged paragraph.
std::string item(const std::string& tag, const std::string& text) {
  return fmt::format(".TP\n{}\n{}\n", tag, escaped(text));
}

std::string described(const CLI::Option& option) {
  std::string tag;
  for (const std::string& name : spellings(option)) tag += (tag.empty() ? "" : ", ") + bold(name);
  if (takes_value(option)) tag += " " + italic(value_name(option));
  std::string text = option.get_description();
  if (const std::string limits = option.get_type_name(); limits.find(" in ") != std::string::npos)
    text += "; " + limits.substr(limits.find(" in ") + 1);
  if (!option.get_default_str().empty()) text += "; default " + option.get_default_str();
  return item(tag, text);
}

/// The footer of --help: paragraphs that end with a colon are the headings of what is indented below them.
std::string closing(const std::string& footer) {
  std::string text;
  std::istringstream lines(footer);
  bool is_as_typed = false;
  for (std::string line; std::getline(lines, line);) {
    const bool is_indented = line.starts_with(' ');
    if (is_indented != is_as_typed && !line.empty()) text += is_indented ? ".RS\n.nf\n" : ".fi\n.RE\n";
    if (!line.empty()) is_as_typed = is_indented;
    if (line.empty())
      text += is_as_typed ? "\n" : "";
    else
      text += is_indented ? escaped(line) + "\n" : ".PP\n" + escaped(line) + "\n";
  }
  return text + (is_as_typed ? ".fi\n.RE\n" : "");
}

std::string see_also(const CLI::App& app) {
  std::string text;
  const auto add = [&](const CLI::App& page) {
    text += (text.empty() ? ".BR " : " ,\n.BR ") + escaped(manual_name(page)) + " (1)";
  };
  if (app.get_parent() != nullptr) add(*app.get_parent());
  for (const CLI::App* one : subcommands(app)) add(*one);
  return text + "\n";
}

}  // namespace

std::string manual_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name() : app.get_parent()->get_name() + "-" + app.get_name();
}

std::string manual_page(const CLI::App& app, const std::string& version) {
  const bool is_program = app.get_parent() == nullptr;
  std::string title = manual_name(app);
  std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
  std::string description = app.get_description();
  if (is_program) description = description.substr(description.find(": ") + 2);
  std::string page =
      fmt::format(".TH {} 1 \"\" \"coast {}\" \"User Commands\"\n.nh\n.ad l\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}\n",
                  escaped(title), version, escaped(manual_name(app)), escaped(description), synopsis(app));
  if (is_program) {
    page += ".SH SUBCOMMANDS\n";
    for (const CLI::App* one : subcommands(app)) page += item(bold(one->get_name()), one->get_description());
  }
  if (const auto positionals = options(app, true); !positionals.empty()) {
    page += ".SH ARGUMENTS\n";
    for (const CLI::Option* one : positionals) page += item(italic(one->get_name(true)), one->get_description());
  }
  page += ".SH OPTIONS\n";
  for (const CLI::Option* one : options(app, false)) page += described(*one);
  page += fmt::format(".SH {}\n{}", is_program ? "EXIT STATUS" : "EXAMPLES", closing(app.get_footer()));
  page +=
      ".SH FILES\n" +
      item(italic("PREFIX/share/coast/configs"),
           "Error models, scenarios, studies and run files; PREFIX is /usr where coast was installed as a Debian package. "
           "Named configs/.. they are found from any "
           "folder that has none of that name.") +
      item(italic("PREFIX/share/doc/coast-doc/html/index.html"),
           "The documentation, where the package coast-doc is installed: every key, every file format, how to read the page.");
  return page + ".SH SEE ALSO\n" + see_also(app);
}

}  // namespace coast::cli
