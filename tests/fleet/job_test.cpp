// coast fleet as a job: its table, its files against their schemas, and spoiled tables.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "coast/io/yaml.hpp"
#include "coast/jobs/fleet.hpp"
#include "fleet/drawn.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"

namespace coast::jobs {
namespace {

constexpr const char* kHeader = "mission,unit,start,quantity,axis,value,sigma,unit_of_value,temperature_degC\n";

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

FleetConfig config_of(const std::filesystem::path& file) {
  FleetConfig config = read_fleet(file);
  config.options.simulations = 99;
  return config;
}

TEST(FleetJob, WritesWhatItsSchemasSay) {
  FleetEstimates estimates;
  estimates.fleet = test::drawn_fleet(31);
  estimates.missions = 180;
  estimates.units = 12;
  estimates.start = geo::GpsTime::from_week(2300, 0.0);
  for (fleet::Estimate& e : estimates.fleet.panels[0].series[3].estimates) e.value += e.t > 1.0 ? 14.0 : 0.0;
  estimates.fleet.panels[1].series[4].estimates[2].value += 40.0;
  FleetConfig config;
  config.file = "fleet.yaml";
  config.options.simulations = 99;
  const FleetResult result = fleet_statistics(config, estimates, {});
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].units, std::vector<std::string>{"u3"});
  const test::TemporaryDirectory folder;
  write(config, result, folder.path());
  for (const std::string& file : files_of(config)) EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;
  const auto json = nlohmann::json::parse(text_of(folder.path() / "fleet.json"));
  test::expect_valid("fleet_result", json);
  test::expect_valid("page", nlohmann::json::parse(text_of(folder.path() / "report.json")));
  EXPECT_EQ(json.at("departures").size(), 1U);
  EXPECT_EQ(json.at("departures").at(0).at("mission"), "u4-2");
  const std::string lines = told(config, result, folder.path());
  EXPECT_NE(lines.find("Unit u3 changed on 2025-0"), std::string::npos) << lines;  // week 2300 begins on 2024-02-04
  EXPECT_NE(lines.find("Mission u4-2 of unit u4"), std::string::npos) << lines;
}

TEST(FleetJob, ReadsItsExampleAndRefusesSpoiledKeys) {
  EXPECT_EQ(test::yaml_as_json(fleet_example("")), test::schema("fleet").at("examples").at(0));
  const test::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "fleet.yaml";
  const auto read = [&](const std::string& text) {
    std::ofstream(file) << text;
    return read_fleet(file);
  };
  EXPECT_EQ(read(fleet_example("")).estimates.size(), 2U);
  EXPECT_THROW(static_cast<void>(read("schema: coast.fleet/1\nestimates: []\n")), InputError);
  EXPECT_THROW(static_cast<void>(read("schema: coast.fleet/1\nestimates: a.csv\nfalse_alarm_probability: 1\n")), InputError);
  EXPECT_THROW(static_cast<void>(read("schema: coast.fleet/1\nestimates: a.csv\ngruops: [a]\n")), InputError);
}

TEST(FleetJob, RefusesSpoiledTablesWithTheirLine) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "estimates.csv";
  const auto message = [&](const std::string& rows) -> std::string {
    std::ofstream(file) << kHeader << "a,u,2025-07-08T19:34:18,gyro_bias,x,1e-3,1e-5,rad/s,20\n" << rows;
    try {
      static_cast<void>(read_estimates(config_of(file)));
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message("b,u,2025-07-09T19:34:18,gyro_bias,x,1e-3,1e-5,rad/s,\n"), "");
  const auto names_line_3 = [&](const std::string& row, const std::string& what) {
    const std::string text = message(row);
    EXPECT_NE(text.find("estimates.csv:3: "), std::string::npos) << text;
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  names_line_3("b,u,2025-07-09T19:34:18,gyro_bias,x,1e-3,0,rad/s,20\n", "sigma 0");
  names_line_3("b,u,2025-07-09T19:34:18,gyro_bias,x,nan,1e-5,rad/s,20\n", "value nan");
  names_line_3("b,u,yesterday,gyro_bias,x,1e-3,1e-5,rad/s,20\n", "yesterday");
  names_line_3("a,u,2025-07-09T19:34:18,gyro_bias,x,1e-3,1e-5,rad/s,20\n", "again");
  names_line_3("b,u,2025-07-09T19:34:18,gyro_bias,x,1e-3,1e-5,deg/h,20\n", "deg/h");
  names_line_3("b,,2025-07-09T19:34:18,gyro_bias,x,1e-3,1e-5,rad/s,20\n", "no unit");
  names_line_3("b,u,2025-07-09T19:34:18,gyro_bias,x,1e-3,1e-5,rad/s,900\n", "900");
}

TEST(FleetJob, FewMissionsGiveFewNumbers) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "estimates.csv";
  std::ofstream(file) << kHeader << "a,u,2025-07-08T19:34:18,time_offset,,0.1,0.001,s,\n"
                      << "a,v,2025-07-08T19:34:18,time_offset,,0.1,0.001,s,\n"
                      << "b,v,2025-07-08T19:34:18,time_offset,,0.1,0.001,s,\n";
  const FleetConfig config = config_of(file);
  const FleetResult result = fleet_statistics(config, {});
  write(config, result, folder.path());
  test::expect_valid("fleet_result", nlohmann::json::parse(text_of(folder.path() / "fleet.json")));
  for (const char* name : {"fleet.json", "pooled.csv", "missions.csv"})
    EXPECT_EQ(text_of(folder.path() / name).find("nan"), std::string::npos) << name;
  EXPECT_TRUE(result.findings.empty());
}

}  // namespace
}  // namespace coast::jobs
