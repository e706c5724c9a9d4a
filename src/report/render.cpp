#include "coast/report/render.hpp"

#include <stdexcept>

#include "template.hpp"

namespace coast::report {
namespace {

constexpr std::string_view kTitleMark = "<!--coast:title-->";
constexpr std::string_view kDataMark = "<!--coast:data-->";

std::string escape_html(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

// Inside <script> the text must not contain "</script" or "<!--"; in JSON '<' occurs within strings only.
std::string escape_script(std::string_view text) {
  std::string out;
  out.reserve(text.size() + text.size() / 64);
  for (const char c : text) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

std::string render(const Page& page) {
  const std::string_view frame = page_template();
  const std::size_t title = frame.find(kTitleMark);
  const std::size_t data = frame.find(kDataMark);
  if (title == std::string_view::npos || data == std::string_view::npos || data < title) {
    throw std::logic_error("the page template lacks its marks");
  }
  std::string html;
  html += frame.substr(0, title);
  html += escape_html(page.title);
  html += frame.substr(title + kTitleMark.size(), data - title - kTitleMark.size());
  html += escape_script(to_json(page));
  html += frame.substr(data + kDataMark.size());
  return html;
}

}  // namespace coast::report
