#pragma once
// The page of `coast synth`.

#include "coast/report/page.hpp"
#include "synth_result.hpp"

namespace coast::cli {

[[nodiscard]] report::Page synth_page(const ArrayConfig& config, const SynthResult& result);

}  // namespace coast::cli
