#pragma once

namespace coast::noise {

struct Interval {
  double lower = 0.0;
  double upper = 0.0;
};

}  // namespace coast::noise
