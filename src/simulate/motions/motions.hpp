#pragma once

#include "drive.hpp"

namespace coast::simulate {

[[nodiscard]] MotionPlan at_rest(const MotionParameters& parameters);
[[nodiscard]] MotionPlan car_roundabout(const MotionParameters& parameters);
[[nodiscard]] MotionPlan car_straight(const MotionParameters& parameters);
[[nodiscard]] MotionPlan city(const MotionParameters& parameters);
[[nodiscard]] MotionPlan survey_drone(const MotionParameters& parameters);
[[nodiscard]] MotionPlan aircraft_lines(const MotionParameters& parameters);
[[nodiscard]] MotionPlan boat(const MotionParameters& parameters);
[[nodiscard]] MotionPlan ski(const MotionParameters& parameters);
[[nodiscard]] MotionPlan pedestrian(const MotionParameters& parameters);

}  // namespace coast::simulate
