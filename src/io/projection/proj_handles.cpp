#include "proj_handles.hpp"

namespace coast::io {

namespace {

void keep_last(void* log, int, const char* message) {
  *static_cast<std::string*>(log) = message;
}

}  // namespace

ProjContext::ProjContext() : log_(std::make_unique<std::string>()), context_(proj_context_create(), &proj_context_destroy) {
  proj_context_set_enable_network(context_.get(), 0);
  proj_log_func(context_.get(), log_.get(), &keep_last);
}

std::string ProjContext::take_log() {
  std::string text;
  std::swap(text, *log_);
  const std::size_t colon = text.find(": ");
  return text.starts_with("proj_") && colon != std::string::npos ? text.substr(colon + 2) : text;
}

}  // namespace coast::io
