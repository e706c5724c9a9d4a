#include "coast/geo/reference_frame.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"

namespace coast::geo {
namespace {

using Eigen::Vector3d;

const Vector3d kStill = Vector3d::Zero();

void expect_near(const Vector3d& a, const Vector3d& b, double tolerance, const std::string& what) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << what << ", component " << i;
}

// Three places that are not in a plane with the centre: seven parameters are seen by nine components.
const std::array<Vector3d, 3> kPlaces = {Vector3d(4075580.5, 931853.75, 4801568.0),      // Wettzell
                                         Vector3d(-4052052.75, 4212836.0, -2545104.75),  // Alice Springs
                                         Vector3d(-2430601.5, -4702442.25, 3546587.5)};  // Goldstone

struct Shift {
  const char* frame;
  std::array<std::array<double, 3>, 3> metres;  // frame minus ITRF2020, per place
  double tolerance;                             // m
};

class FromItrf2020 : public testing::TestWithParam<Shift> {};

// PROJ 9.1.1 (cct) with the parameters of EPSG v10.076, at 2023.25. "cct -I urn:ogc:def:coordinateOperation:EPSG::<code>" with
// 9991 to 9999 for the ITRFs; 9991 then 8366 and 8405 for ETRF2014 and ETRF2000, 8049 for GDA2020; 9992 then 7807 to 7809 for
// NAD83. The last start from ITRF2008, where the table of the source starts from ITRF2020: other numbers, digits enough for
// 1e-5.
INSTANTIATE_TEST_SUITE_P(
    Proj, FromItrf2020,
    testing::Values(
        Shift{"ITRF2014",
              {{{-0.003112, -0.002116, 0.001033}, {0.000302, -0.003494, 0.004119}, {-0.000379, 0.000250, 0.001560}}},
              1e-6},
        Shift{"ITRF2008",
              {{{0.000027, 0.000135, 0.003921}, {0.000372, -0.000004, 0.004233}, {0.000303, 0.000375, 0.003974}}},
              1e-6},
        Shift{"ITRF2005",
              {{{0.008833, 0.000111, 0.003734}, {0.001538, 0.003056, -0.002859}, {0.002994, -0.004945, 0.002608}}},
              1e-6},
        Shift{"ITRF2000",
              {{{0.013494, 0.003742, -0.033064}, {-0.012169, 0.014102, -0.056261}, {-0.007050, -0.014048, -0.037027}}},
              1e-6},
        Shift{"ITRF97",
              {{{0.025209, 0.006155, -0.079611}, {-0.023537, 0.001774, -0.116124}, {0.007214, -0.038408, -0.085848}}},
              1e-6},
        Shift{"ITRF96",
              {{{0.025209, 0.006155, -0.079611}, {-0.023537, 0.001774, -0.116124}, {0.007214, -0.038408, -0.085848}}},
              1e-6},
        Shift{"ITRF94",
              {{{0.025209, 0.006155, -0.079611}, {-0.023537, 0.001774, -0.116124}, {0.007214, -0.038408, -0.085848}}},
              1e-6},
        Shift{"ITRF93",
              {{{-0.209931, 0.130910, 0.033191}, {-0.065368, -0.055483, -0.307188}, {-0.173310, 0.032308, -0.043115}}},
              1e-6},
        Shift{"ITRF92",
              {{{0.030315, 0.007493, -0.091020}, {-0.012660, 0.000783, -0.122317}, {0.016940, -0.033069, -0.096367}}},
              1e-6},
        Shift{"ETRF2014",
              {{{0.539396, -0.590980, -0.345166}, {0.314538, 0.550513, 0.420856}, {-0.288912, 0.260964, 0.149500}}},
              1e-6},
        Shift{"ETRF2000",
              {{{0.580716, -0.545820, -0.400136}, {0.388784, 0.632221, 0.282092}, {-0.282906, 0.308900, 0.049489}}},
              1e-6},
        Shift{"GDA2020",
              {{{-0.074923, 0.034134, 0.054951}, {0.127891, 0.013273, -0.171261}, {-0.155956, 0.130516, 0.067658}}},
              1e-6},
        Shift{"NAD83(2011)",
              {{{1.299996, -1.478391, -0.894016}, {1.098809, -2.063077, -0.914664}, {0.962876, -1.317673, 0.192755}}},
              1e-5},
        Shift{"NAD83(PA11)",
              {{{-0.252177, -0.519000, 0.115385}, {0.273779, -3.291914, -1.761062}, {1.463431, -2.368710, -0.664799}}},
              1e-5},
        Shift{"NAD83(MA11)",
              {{{0.616152, -1.344602, -0.461427}, {1.056921, -2.354544, -1.456300}, {0.680714, -1.541168, -0.103980}}},
              1e-5}),
    [](const auto& row) {
      std::string name = row.param.frame;
      name.erase(std::remove_if(name.begin(), name.end(), [](char c) { return c == '(' || c == ')'; }), name.end());
      return name;
    });

TEST_P(FromItrf2020, AgreesWithProj) {
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    const Vector3d r = transform(kPlaces[i], {"ITRF2020", 2023.25}, {GetParam().frame, 2023.25}, kStill);
    expect_near(r - kPlaces[i], Vector3d(GetParam().metres[i].data()), GetParam().tolerance, GetParam().frame);
  }
}

TEST(ReferenceFrame, PublishedStationsOfTheEpn) {
  // EPN Central Bureau, positions and velocities C2385 at 2020.0 (epncb.oma.be, crd4station.php): IGS20, then ETRF2020, as
  // printed to 0.1 mm and 0.1 mm/year; for Bautzen also X in ETRF2014. Both are rounded, so half a digit each.
  struct Station {
    const char* name;
    Vector3d igs20, igs20_velocity, etrf2020, etrf2020_velocity;
  };
  const std::array<Station, 3> stations = {{{"BAUT",
                                             {3877545.5293, 1004370.8982, 4947148.0645},
                                             {-0.0159, 0.0163, 0.0102},
                                             {3877546.0288, 1004370.3955, 4947147.7750},
                                             {0.0003, 0.0001, 0.0008}},
                                            {"EBRE",
                                             {4833519.9859, 41537.4029, 4147461.7253},
                                             {-0.0110, 0.0198, 0.0118},
                                             {4833520.3141, 41536.8023, 4147461.3488},
                                             {-0.0004, 0.0004, -0.0003}},
                                            {"NPAZ",
                                             {4365990.6595, 1634053.5604, 4339210.8587},
                                             {-0.0174, 0.0189, 0.0096},
                                             {4365991.1829, 1634053.0102, 4339210.5393},
                                             {-0.0006, 0.0011, -0.0007}}}};
  for (const Station& s : stations) {
    expect_near(transform(s.igs20, {"IGS20", 2020.0}, {"ETRF2020", 2020.0}, s.igs20_velocity), s.etrf2020, 1.05e-4, s.name);
    expect_near(velocity_in_frame(s.igs20_velocity, s.igs20, "IGS20", "ETRF2020"), s.etrf2020_velocity, 1.05e-4, s.name);
    // Five years later by either velocity: five times its rounding more.
    const Vector3d later = s.etrf2020 + 5.0 * s.etrf2020_velocity;
    expect_near(transform(s.igs20, {"IGS20", 2020.0}, {"ETRF2020", 2025.0}, s.igs20_velocity), later, 6.1e-4, s.name);
  }
  EXPECT_NEAR(transform(stations[0].igs20, {"IGS20", 2020.0}, {"ETRF2014", 2020.0}, kStill).x(), 3877546.0373, 1.05e-4);

  // The same for Malaga, C2235 at 2010.0, printed to 1 mm: ETRF2014 and ETRF2000.
  expect_near(transform({5103282.356, -392096.809, 3793146.918}, {"ETRF2014", 2010.0}, {"ETRF2000", 2010.0}, kStill),
              {5103282.405, -392096.768, 3793146.874}, 1.05e-3, "MALA");
}

TEST(ReferenceFrame, WorkedExampleOfGda2020) {
  // Alice Springs, ITRF2014 at 2018.0 to GDA2020: example of the GDA2020 Technical Manual 1.0 as PROJ's tests (GDA.gie) quote
  // it, to 0.1 mm. The target epoch 2018.0 turns the frame; the ground is not moved.
  expect_near(transform({-4052052.6588, 4212835.9938, -2545104.6946}, {"ITRF2014", 2018.0}, {"GDA2020", 2018.0}, kStill),
              {-4052052.7373, 4212835.9835, -2545104.5867}, 1.05e-4, "ALIC");
}

TEST(ReferenceFrame, SumsOfTheOlderTables) {
  // Table of the ITRF2008 itself (Transfo-ITRF2008_ITRFs.txt), ITRF2008 to ITRF2000 at 2000.0: a translation, with D r added.
  const Vector3d& r = kPlaces[0];
  const Vector3d expected = r + 1e-3 * Vector3d(-1.9, -1.7, -10.5) + 1.34e-9 * r;
  expect_near(transform(r, {"ITRF2008", 2000.0}, {"ITRF2000", 2000.0}, kStill), expected, 2e-9, "ITRF2008 to ITRF2000");
}

TEST(ReferenceFrame, TranslationAndScaleByHand) {
  // At the pole's axis point of 1000 km, ITRF2020 to ITRF2014 at 2025.0: T = (-1.4, -1.9, 3.4) mm, D r = -0.42 mm along z.
  const Vector3d r(0.0, 0.0, 1e6);
  expect_near(transform(r, {"ITRF2020", 2025.0}, {"ITRF2014", 2025.0}, kStill) - r, {-1.4e-3, -1.9e-3, 3.4e-3 - 0.42e-3}, 1e-9,
              "ITRF2014");
}

TEST(ReferenceFrame, OnlyTheEpochInOneFrame) {
  const Vector3d v(-0.0155, 0.0171, 0.0105);
  expect_near(transform(kPlaces[0], {"IGb14", 2010.0}, {"ITRF2014", 2030.0}, v), kPlaces[0] + 20.0 * v, 1e-9, "one frame");
}

TEST(ReferenceFrame, ThereAndBack) {
  for (const std::string& from : frames()) {
    for (const std::string& to : frames()) {
      for (const Vector3d& r : kPlaces) {
        const Vector3d there = transform(r, {from, 2012.5}, {to, 2012.5}, kStill);
        expect_near(transform(there, {to, 2012.5}, {from, 2012.5}, kStill), r, 1e-9, fmt::format("{} and {}", from, to));
      }
    }
  }
}

TEST(ReferenceFrame, MovingThenTransformingIsTransformingThenMoving) {
  // With the velocity carried over: what is left is (D + R) v and the rates on the metres between the frames, 1e-7 m/year.
  const Vector3d v(0.03, -0.02, 0.05);
  for (const std::string& from : frames()) {
    for (const std::string& to : frames()) {
      const Vector3d& r = kPlaces[1];
      const Vector3d direct = transform(r, {from, 2010.0}, {to, 2020.0}, v);
      const Vector3d first = transform(r, {from, 2010.0}, {to, 2010.0}, v);
      const Vector3d second = transform(first, {to, 2010.0}, {to, 2020.0}, velocity_in_frame(v, r, from, to));
      expect_near(direct, second, 1e-6, fmt::format("{} and {}", from, to));
    }
  }
}

TEST(ReferenceFrame, NamesAndTheirAliases) {
  EXPECT_EQ(frame_of("itrf2014"), "ITRF2014");
  EXPECT_EQ(frame_of("IGb14"), "ITRF2014");
  EXPECT_EQ(frame_of("WGS 84 (g2139)"), "ITRF2014");
  EXPECT_EQ(frame_of("WGS84"), "ITRF2020");
  EXPECT_EQ(frame_of("NAD83(CSRS)"), "NAD83(2011)");
  EXPECT_EQ(frame_of("ETRS89"), std::nullopt);
  EXPECT_EQ(frame_of(""), std::nullopt);
  for (const std::string& name : frames()) {
    ASSERT_TRUE(frame_of(name).has_value()) << name;
    EXPECT_EQ(frame_of(*frame_of(name)), frame_of(name)) << name;
  }
}

TEST(ReferenceFrame, ErrorsNameTheArgument) {
  try {
    (void)transform(kPlaces[0], {"ITRF2041", 2020.0}, {"ITRF2020", 2020.0}, kStill);
    FAIL() << "an unknown frame passed";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("'ITRF2041'"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("nearest is ITRF2014"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("ETRF2000"), std::string::npos) << e.what();
  }
  // A modified Julian date, a two-digit year, no number.
  for (const double year : {58849.0, 20.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW((void)transform(kPlaces[0], {"ITRF2020", year}, {"ITRF2020", 2020.0}, kStill), std::invalid_argument) << year;
    EXPECT_THROW((void)transform(kPlaces[0], {"ITRF2020", 2020.0}, {"ITRF2020", year}, kStill), std::invalid_argument) << year;
  }
  EXPECT_THROW((void)velocity_in_frame(kStill, kPlaces[0], "ITRF2020", "NAD83"), std::invalid_argument);
  EXPECT_THROW((void)plate_velocity("EURA", kPlaces[0], "ETRS89"), std::invalid_argument);
}

TEST(PlateVelocity, StationsInTheMiddleOfPlates) {
  // Bautzen and Ebre as the EPN prints them (see above), Wettzell in ITRF2014 to 0.5 mm/year, Alice Springs by the rotation
  // that defines GDA2020, which is a fit to Australian stations alone. Vertical motion is in the stations and not in the model:
  // 1 mm.
  expect_near(*plate_velocity("EURA", {3877545.53, 1004370.90, 4947148.06}), {-0.0159, 0.0163, 0.0102}, 1e-3, "BAUT");
  expect_near(*plate_velocity("EURA", {4833519.99, 41537.40, 4147461.73}), {-0.0110, 0.0198, 0.0118}, 1e-3, "EBRE");
  expect_near(*plate_velocity("eura", kPlaces[0], "ITRF2014"), {-0.0155, 0.0171, 0.0105}, 1e-3, "WTZR");
  expect_near(*plate_velocity("AUST", kPlaces[1], "GDA2020"), kStill, 1e-3, "ALIC");
}

TEST(PlateVelocity, RestsInTheFrameOfItsPlate) {
  // ETRF2020 turns with the pole of EURA (R1 rounded apart: 0.086 and 0.085 mas, 0.03 mm/year); what is left is the bias.
  const Vector3d v = *plate_velocity("EURA", kPlaces[0], "ETRF2020");
  EXPECT_LT(v.norm(), 1e-3);
  EXPECT_GT(plate_velocity("EURA", kPlaces[0], "ITRF2020")->norm(), 0.02);
}

TEST(PlateVelocity, HorizontalRotationAndBias) {
  // Closed form at a point of the equator: omega x r has no vertical part there, and up is r itself.
  const double a = 6378137.0;
  const Vector3d r(a, 0.0, 0.0);
  const double mas = kDegree / 3.6e6;
  // PCFC (-0.404, 1.021, -2.154) mas/year; omega x r = (0, omega_z a, -omega_y a); bias (0.37, 0.35, 0.74) mm/year.
  const Vector3d expected(0.0, -2.154 * mas * a + 0.35e-3, -1.021 * mas * a + 0.74e-3);
  expect_near(*plate_velocity("PCFC", r), expected, 1e-12, "PCFC");
}

TEST(PlateVelocity, EveryPlateAgainstTheProductFile) {
  // ITRF2020-PMM.dat (itrf.ign.fr), deg/Myr to four decimals: other digits of the same poles than those of the paper in
  // mas/year.
  struct Pole {
    const char* plate;
    Vector3d omega;
  };
  const std::array<Pole, 13> poles = {{{"AMUR", {-0.0364, -0.1532, 0.2325}},
                                       {"ANTA", {-0.0746, -0.0866, 0.1882}},
                                       {"ARAB", {0.3135, -0.0406, 0.3994}},
                                       {"AUST", {0.4132, 0.3265, 0.3398}},
                                       {"CARB", {0.0576, -0.3949, 0.2017}},
                                       {"EURA", {-0.0237, -0.1442, 0.2091}},
                                       {"INDI", {0.3159, 0.0037, 0.4010}},
                                       {"NAZC", {-0.0907, -0.4336, 0.4459}},
                                       {"NOAM", {0.0126, -0.1849, -0.0272}},
                                       {"NUBI", {0.0250, -0.1625, 0.1991}},
                                       {"PCFC", {-0.1122, 0.2836, -0.5984}},
                                       {"SOAM", {-0.0725, -0.0784, -0.0437}},
                                       {"SOMA", {-0.0225, -0.1997, 0.2401}}}};
  ASSERT_EQ(plates().size(), poles.size());
  for (const Pole& pole : poles) {
    for (const Vector3d& r : kPlaces) {
      const Vector3d up = -C_n_e(geodetic_from_ecef(r)).col(2);
      const Vector3d v = 1e-6 * kDegree * pole.omega.cross(r) + 1e-3 * Vector3d(0.37, 0.35, 0.74);
      // Rounding: 5e-5 deg/Myr and 5e-4 mas/year, that is 8.7e-13 and 2.4e-12 rad/year, on two components of 5e6 m.
      expect_near(*plate_velocity(pole.plate, r), v - up * up.dot(v), 3.5e-5, pole.plate);
    }
  }
}

TEST(PlateVelocity, UnknownPlate) {
  EXPECT_EQ(plate_velocity("JUAN", kPlaces[0]), std::nullopt);
  for (const std::string& name : plates()) EXPECT_TRUE(plate_velocity(name, kPlaces[0]).has_value()) << name;
}

}  // namespace
}  // namespace coast::geo
