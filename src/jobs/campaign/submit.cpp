// Scripts with which a cluster or one machine runs the shards of a campaign.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "coast/io/sha256.hpp"
#include "coast/io/writers.hpp"
#include "coast/jobs/campaign.hpp"

namespace coast::jobs {

namespace {

namespace fs = std::filesystem;

/// Between single quotes of a shell.
std::string quoted(const std::string& text) {
  std::string safe = "'";
  for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return safe + "'";
}

struct Commands {
  std::string campaign;  ///< "coast campaign"
  std::string files;     ///< the plan and the folder of results

  [[nodiscard]] std::string run(const std::string& shard) const {
    return fmt::format("{} run {} --shard {} --threads 1 --quiet", campaign, files, shard);
  }
  [[nodiscard]] std::string collect() const { return fmt::format("{} collect {} --quiet", campaign, files); }
};

Commands commands(const CampaignConfig& config, const fs::path& out) {
  std::string data;
  if (const char* folder = std::getenv("COAST_DATA"); folder != nullptr && *folder != '\0')
    data = fmt::format("env COAST_DATA={} ", quoted(fs::absolute(folder).string()));
  return {fmt::format("{}{} campaign", data, quoted(fs::read_symlink("/proc/self/exe").string())),
          fmt::format("{} --out {}", quoted(fs::absolute(config.file).lexically_normal().string()), quoted(out.string()))};
}

/// Minutes of a shard and megabytes of a unit, with room for what the trial did not show.
struct Request {
  long minutes = 0;
  long megabytes = 0;
};
Request request(const CampaignEstimate& estimate) {
  constexpr double kTimeFactor = 2.0, kMemoryFactor = 1.5, kMemoryAtLeast = 256.0;  // MB: of the program itself
  return {static_cast<long>(std::ceil(kTimeFactor * estimate.shard_seconds() / 60.0)) + 1,
          static_cast<long>(std::ceil(std::max(kMemoryAtLeast, kMemoryFactor * estimate.memory_bytes() / 1e6)))};
}

std::string write_slurm(const Commands& use, const fs::path& out, const CampaignEstimate& estimate) {
  const Request ask = request(estimate);
  const std::string log = (out / "slurm-%j.log").string();
  io::write_text(out / "shards.slurm",
                 fmt::format("#!/bin/bash\n#SBATCH --job-name=coast\n#SBATCH --array=1-{}\n#SBATCH --ntasks=1\n"
                             "#SBATCH --cpus-per-task=1\n#SBATCH --time={}\n#SBATCH --mem={}M\n#SBATCH --requeue\n"
                             "#SBATCH --open-mode=append\n#SBATCH --output={}\n"
                             "# Status 3 is that of units whose numbers failed: they are collected with their errors.\n"
                             "exec {}\n",
                             estimate.shards, ask.minutes, ask.megabytes, log,
                             use.run(fmt::format("\"$SLURM_ARRAY_TASK_ID\"/{}", estimate.shards))));
  // A task that is killed and requeued counts as ended for `afterany`: this job does what such a task has left.
  io::write_text(out / "collect.slurm",
                 fmt::format("#!/bin/bash\n#SBATCH --job-name=coast-collect\n#SBATCH --ntasks=1\n#SBATCH --time={}\n"
                             "#SBATCH --mem={}M\n#SBATCH --requeue\n#SBATCH --output={}\n"
                             "# What a task has left that was requeued, which counts as ended.\n{}\nexec {}\n",
                             ask.minutes + 60, std::max(1024L, ask.megabytes), log, use.run("1/1"), use.collect()));
  io::write_text(out / "submit.sh",
                 fmt::format("#!/bin/bash\nset -euo pipefail\nshards=$(sbatch --parsable {})\n"
                             "sbatch --parsable --dependency=afterany:\"$shards\" {}\n",
                             quoted((out / "shards.slurm").string()), quoted((out / "collect.slurm").string())));
  return "bash " + quoted((out / "submit.sh").string());
}

/// Marks of finished shards are those of one plan: with another there is other work, under the same numbers.
std::string marks(const CampaignConfig& config) {
  return "shards-" + io::sha256_of_file(config.file).substr(0, 12);
}

std::string write_parallel(const Commands& use, const CampaignConfig& config, const fs::path& out,
                           const CampaignEstimate& estimate) {
  const std::string log = (out / (marks(config) + ".log")).string();
  io::write_text(
      out / "parallel.sh",
      fmt::format("#!/bin/bash\n# As many shards at a time as there are processors, or as parallel's own options here say.\n"
                  "parallel --joblog {} --resume-failed \"$@\" {} ::: {{1..{}}}\n{}\n",
                  quoted(log), quoted(use.run(fmt::format("{{}}/{}", estimate.shards))), estimate.shards, use.collect()));
  return "bash " + quoted((out / "parallel.sh").string());
}

std::string write_snakemake(const Commands& use, const CampaignConfig& config, const fs::path& out,
                            const CampaignEstimate& estimate) {
  const Request ask = request(estimate);
  const auto python = [](const std::string& text) {  // a string of it
    std::string literal = "\"";
    for (const char c : text) literal += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
    return literal + '"';
  };
  const auto braces = [](const std::string& text) {  // of the shell, not of snakemake
    std::string safe;
    for (const char c : text) safe.append(c == '{' || c == '}' ? 2 : 1, c);
    return safe;
  };
  io::write_text(
      out / "Snakefile",
      fmt::format("SHARDS = range(1, {} + 1)\n\nrule collect:\n    input: expand('{}/{{n}}.done', n=SHARDS)\n    shell: {}\n\n"
                  "rule shard:\n    output: touch('{}/{{n}}.done')\n"
                  "    resources: mem_mb={}, runtime={}\n    retries: 3\n"
                  "    # Status 3: units whose numbers failed, which are collected with their errors.\n"
                  "    shell: {}\n",
                  estimate.shards, marks(config), python(braces(use.collect())), marks(config), ask.megabytes, ask.minutes,
                  python(braces(use.run("WILDCARD"))
                             .replace(braces(use.run("WILDCARD")).find("WILDCARD"), 8,
                                      fmt::format("{{wildcards.n}}/{}", estimate.shards)) +
                         " || test $? -eq 3")));
  return fmt::format("snakemake --directory {0} --snakefile {0}/Snakefile --cores all", quoted(out.string()));
}

}  // namespace

std::string write_submission(const CampaignConfig& config, const fs::path& folder, CampaignEngine engine,
                             const CampaignEstimate& estimate) {
  const fs::path out = fs::absolute(folder).lexically_normal();
  const Commands use = commands(config, out);
  switch (engine) {
    case CampaignEngine::kSlurm:
      return write_slurm(use, out, estimate);
    case CampaignEngine::kParallel:
      return write_parallel(use, config, out, estimate);
    case CampaignEngine::kSnakemake:
      return write_snakemake(use, config, out, estimate);
  }
  return {};
}

}  // namespace coast::jobs
