// Simulates a shipped scenario, processes its recording in memory, and asks: how far is the smoothed end from the truth?
#include <coast/jobs/process.hpp>
#include <coast/jobs/simulate.hpp>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const coast::jobs::SimulationConfig simulation = coast::jobs::read_simulate(argv[1]);
  const coast::simulate::SimulatedMission simulated = coast::jobs::simulate(simulation, {}).mission;

  coast::jobs::RunConfig run;
  run.setup.model = *simulation.scenario.error_model;
  run.setup.lever_arm_b = simulation.scenario.gnss.lever_arm_b;
  coast::jobs::Recordings recordings;
  recordings.imu = simulated.imu;
  recordings.gnss = simulated.gnss;
  const coast::jobs::ProcessedMission mission = coast::jobs::process(run, recordings, coast::jobs::Progress{});

  const double error = (mission.delivered.back().nav.r_eb_e - simulated.truth.states.back().r_eb_e).norm();
  std::printf("%zu epochs, %.4f m from the truth; %s\n", mission.delivered.size(), error,
              mission.result.verdict.line().c_str());
  // tests/study holds the filter to its bounds; here a wrong link or a wrong flag would show.
  return error < 1.0 ? 0 : 1;
}
