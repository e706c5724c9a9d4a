#include "search/explanation.hpp"

#include <algorithm>
#include <array>

namespace coast::diagnose {

namespace {

std::array<double, 12> numbers_of(const estimate::NoiseAdjustment& a) {
  const auto& [scale, correlated, gyro, accel] = a;
  return {scale.horizontal,
          scale.vertical,
          scale.velocity,
          correlated.horizontal_m,
          correlated.vertical_m,
          correlated.time_s,
          gyro.x(),
          gyro.y(),
          gyro.z(),
          accel.x(),
          accel.y(),
          accel.z()};
}

bool is_same(const std::optional<estimate::NoiseAdjustment>& a, const std::optional<estimate::NoiseAdjustment>& b) {
  return a && b ? numbers_of(*a) == numbers_of(*b) : a.has_value() == b.has_value();
}

bool is_same_axis(const TurnOn& a, const TurnOn& b) {
  return a.sensor == b.sensor && a.axis == b.axis;
}

/// A running hash over values of any kind.
class Hash {
 public:
  template <typename T>
  Hash& add(const T& value) {
    value_ = combined(value_, std::hash<T>{}(value));
    return *this;
  }
  Hash& add_time(const std::optional<geo::GpsTime>& t) { return add(t ? t->nanoseconds() : std::int64_t{-1}); }
  [[nodiscard]] std::size_t value() const { return value_; }

 private:
  std::size_t value_ = 0;
};

}  // namespace

std::size_t combined(std::size_t a, std::size_t b) {
  return a ^ (b + 0x9e3779b97f4a7c15U + (a << 6U) + (a >> 2U));  // boost::hash_combine
}

bool Explanation::operator==(const Explanation& other) const {
  return imu == other.imu && effects == other.effects && suggested == other.suggested && is_same(noise, other.noise) &&
         random == other.random && std::ranges::equal(shared, other.shared, is_same_axis);
}

std::size_t Explanation::hash() const {
  Hash h;
  h.add(imu.get());
  for (const SelectedEffect& one : effects) h.add(one.hypothesis).add_time(one.from).add_time(one.to).add(one.value);
  for (const EffectPtr& effect : suggested) h.add(effect.get());
  if (noise)
    for (const double number : numbers_of(*noise)) h.add(number);
  for (const AddedNoise& one : random) h.add(one.effect).add(one.axis).add(one.root).add(one.time);
  for (const TurnOn& bias : shared) h.add(static_cast<int>(bias.sensor)).add(bias.axis);
  return h.value();
}

bool Explanation::is_suggested(const Effect& effect) const {
  return std::ranges::find(suggested, &effect, &EffectPtr::get) != suggested.end();
}

bool Explanation::is_shared(const TurnOn& bias) const {
  return std::ranges::any_of(shared, [&](const TurnOn& other) { return is_same_axis(bias, other); });
}

Explanation Explanation::with(const SelectedEffect& effect) const {
  Explanation more = *this;
  more.effects.push_back(effect);
  return more;
}

Explanation Explanation::without(std::size_t first, std::size_t count) const {
  Explanation less = *this;
  const auto at = less.effects.begin() + static_cast<std::ptrdiff_t>(first);
  less.effects.erase(at, at + static_cast<std::ptrdiff_t>(count));
  return less;
}

void Explanation::add_noise(MissionInput& input) const {
  if (noise) {
    input.setup.model = estimate::adjusted(input.setup.model, *noise);
    input.setup.filter = estimate::adjusted(input.setup.filter, *noise);
  }
  for (const AddedNoise& one : random) one.add_to(input);
}

}  // namespace coast::diagnose
