#include "coast/geo/units.hpp"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace coast::geo {
namespace {

struct Case {
  const char* name;
  double si;  // worked out by hand from pi = 3.14159265358979 and g = 9.80665
  Dimension dimension;
};

TEST(Units, TableOfDataSheetNames) {
  const Case cases[] = {
      {"rad/s/sqrt(Hz)", 1.0, Dimension::kAngularRateNoise},
      {"deg/sqrt(h)", 2.90888208665722e-4, Dimension::kAngularRateNoise},
      {"deg/s/sqrt(Hz)", 1.74532925199433e-2, Dimension::kAngularRateNoise},
      {"deg/h/sqrt(Hz)", 4.84813681109536e-6, Dimension::kAngularRateNoise},
      {"m/s^2/sqrt(Hz)", 1.0, Dimension::kSpecificForceNoise},
      {"m/s/sqrt(h)", 1.66666666666667e-2, Dimension::kSpecificForceNoise},
      {"ug/sqrt(Hz)", 9.80665e-6, Dimension::kSpecificForceNoise},
      {"rad/s", 1.0, Dimension::kAngularRate},
      {"deg/s", 1.74532925199433e-2, Dimension::kAngularRate},
      {"dps", 1.74532925199433e-2, Dimension::kAngularRate},
      {"deg/h", 4.84813681109536e-6, Dimension::kAngularRate},
      {"m/s^2", 1.0, Dimension::kSpecificForce},
      {"g", 9.80665, Dimension::kSpecificForce},
      {"mg", 9.80665e-3, Dimension::kSpecificForce},
      {"ug", 9.80665e-6, Dimension::kSpecificForce},
      {"mGal", 1e-5, Dimension::kSpecificForce},
      {"(m/s^2)^2", 1.0, Dimension::kSpecificForceVariance},
      {"(rad/s)^2", 1.0, Dimension::kAngularRateVariance},
      {"rad/s/sqrt(s)", 1.0, Dimension::kAngularRateWalk},
      {"deg/h/sqrt(h)", 8.08022801849227e-8, Dimension::kAngularRateWalk},
      {"deg/s/sqrt(s)", 1.74532925199433e-2, Dimension::kAngularRateWalk},
      {"m/s^2/sqrt(s)", 1.0, Dimension::kSpecificForceWalk},
      {"ug/sqrt(s)", 9.80665e-6, Dimension::kSpecificForceWalk},
      {"rad/s^2", 1.0, Dimension::kAngularRateRamp},
      {"deg/h/h", 1.34670466974871e-9, Dimension::kAngularRateRamp},
      {"m/s^3", 1.0, Dimension::kSpecificForceRamp},
      {"ug/h", 2.72406944444444e-9, Dimension::kSpecificForceRamp},
      {"rad", 1.0, Dimension::kAngle},
      {"mrad", 1e-3, Dimension::kAngle},
      {"deg", 1.74532925199433e-2, Dimension::kAngle},
      {"mdeg", 1.74532925199433e-5, Dimension::kAngle},
      {"arcsec", 4.84813681109536e-6, Dimension::kAngle},
      {"ppm", 1e-6, Dimension::kRatio},
      {"ppm/K", 1e-6, Dimension::kRatioPerKelvin},
      {"deg/h/K", 4.84813681109536e-6, Dimension::kAngularRatePerKelvin},
      {"ug/K", 9.80665e-6, Dimension::kSpecificForcePerKelvin},
      {"deg/h/g", 4.94372370900905e-7, Dimension::kAngularRatePerForce},
      {"ug/g^2", 1.01971621297793e-7, Dimension::kPerForce},
      {"m/s", 1.0, Dimension::kVelocity},
  };
  for (const Case& c : cases) {
    const Unit& u = unit(c.name);
    EXPECT_EQ(u.dimension, c.dimension) << c.name;
    EXPECT_NEAR(u.to_si / c.si, 1.0, 5e-15) << c.name;  // 15 digits written
    EXPECT_EQ(to_si(2.0, c.name, c.dimension), 2.0 * u.to_si) << c.name;
  }
}

TEST(Units, NamesAreUnique) {
  std::set<std::string_view> names;
  for (const Unit& u : units()) EXPECT_TRUE(names.insert(u.name).second) << u.name;
}

std::string message_of(double value, std::string_view name, Dimension dimension) {
  try {
    (void)to_si(value, name, dimension);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(Units, ErrorsNameWhatFits) {
  EXPECT_EQ(message_of(1, "deg/hr", Dimension::kAngularRate), "unknown unit 'deg/hr', the nearest known is 'deg/h'");
  EXPECT_EQ(message_of(1, "furlongs/fortnight", Dimension::kAngularRate), "unknown unit 'furlongs/fortnight'");
  EXPECT_EQ(message_of(1, "ug", Dimension::kAngularRate),
            "unit 'ug' does not fit here, expected one of rad/s, deg/s, dps, deg/h");
  EXPECT_THROW((void)unit(""), std::invalid_argument);
}

TEST(Units, PsdAndCovarianceAreLinkedByTheInterval) {
  EXPECT_EQ(integrate(Psd{4.0}, 0.25).value, 1.0);
  // The paper's 3.6e-5 (m/s^2)^2 at 100 Hz: averaged over 1 s (100 samples) its variance is 3.6e-7, the density's own number.
  EXPECT_NEAR(density_of_samples(Cov{3.6e-5}, 100.0).value, 3.6e-7, 1e-21);
}

}  // namespace
}  // namespace coast::geo
