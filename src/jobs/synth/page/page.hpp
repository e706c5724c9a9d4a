#pragma once
// The page of `coast synth`.

#include "coast/report/page.hpp"
#include "synth/result.hpp"

namespace coast::jobs {

[[nodiscard]] report::Page synth_page(const ArrayConfig& config, const SynthResult& result);

}  // namespace coast::jobs
