#pragma once
// Objects of PROJ that free themselves. Private to the room.

#include <proj.h>
#include <proj_experimental.h>

#include <memory>
#include <string>

namespace coast::io {

/// A context of PROJ: without network, and what it logs is kept instead of printed.
class ProjContext {
 public:
  ProjContext();
  [[nodiscard]] PJ_CONTEXT* get() const { return context_.get(); }
  /// The last complaint of PROJ, without the name of its function; the log begins anew.
  [[nodiscard]] std::string take_log();

 private:
  std::unique_ptr<std::string> log_;
  std::unique_ptr<PJ_CONTEXT, PJ_CONTEXT* (*)(PJ_CONTEXT*)> context_;
};

struct ProjDelete {
  void operator()(PJ* object) const { proj_destroy(object); }
  void operator()(PJ_OBJ_LIST* list) const { proj_list_destroy(list); }
  void operator()(PJ_OPERATION_FACTORY_CONTEXT* factory) const { proj_operation_factory_context_destroy(factory); }
};
using ProjObject = std::unique_ptr<PJ, ProjDelete>;
using ProjList = std::unique_ptr<PJ_OBJ_LIST, ProjDelete>;
using ProjFactory = std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, ProjDelete>;

}  // namespace coast::io
