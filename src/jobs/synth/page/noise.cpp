#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/array/channel.hpp"
#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"
#include "synth/page/parts.hpp"

namespace coast::jobs {

namespace {

const char* unit_of(int channel) {
  return channel < 3 ? "deg/s" : "mg";
}

double shown(int channel, double value) {
  return value / (channel < 3 ? geo::kDegree : 1e-3 * geo::kStandardGravity);
}

/// One row per channel: a standard deviation of each sensor, of their plain mean, of the merged signal.
template <class Errors>
report::Table sd_table(const ArrayConfig& config, report::Table table, const Errors& errors_of) {
  table.columns = {{"channel", "", false}, {"unit", "", false}};
  for (const ArrayImu& imu : config.imus) table.columns.push_back({imu.name, ""});
  table.columns.push_back({"plain mean", ""});
  table.columns.push_back({"merged", ""});
  for (int c = 0; c < array::kChannels; ++c) {
    const ChannelErrors errors = errors_of(static_cast<std::size_t>(c));
    std::vector<report::Cell> row = cells({channel_name(c), unit_of(c)});
    for (const double sd : errors.sensors) row.push_back({number(shown(c, sd))});
    row.push_back({number(shown(c, errors.plain))});
    row.push_back({number(shown(c, errors.merged))});
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Table noise_table(const ArrayConfig& config, const SynthResult& result) {
  report::Table table{"noise-table",
                      "Noise of a sample, one sigma",
                      "Own noise by the differences of the sensors, Eq. (11) solved for each; merged as the weights have it.",
                      {},
                      {}};
  return sd_table(config, std::move(table), [&](std::size_t c) {
    const array::MergedChannel& channel = result.channels[c];
    return ChannelErrors{own_sds(channel), plain_sd(channel), merged_sd(channel)};
  });
}

report::Table reference_table(const ArrayConfig& config, const SynthResult& result) {
  report::Table table{"reference-table", "Errors against the reference, one sigma", "Means taken off.", {}, {}};
  return sd_table(config, std::move(table), [&](std::size_t c) { return result.against_reference[c]; });
}

/// The paper's Fig. 11: the noise of each sensor over time, and of the merged signal.
report::Panel tracking_panel(const ArrayConfig& config, const SynthResult& result, int c) {
  const array::MergedChannel& channel = result.channels[static_cast<std::size_t>(c)];
  report::Panel panel =
      report::time_panel(fmt::format("noise-{}", c), fmt::format("Noise over time, {}", channel_name(c)), unit_of(c),
                         fmt::format("Standard deviation in blocks of {} s{}. Good: merged below every sensor.",
                                     number(static_cast<double>(channel.noise.block) * result.assembly.signals.dt),
                                     channel.models.empty() ? "" : "; dashed: as GARCH predicts it"));
  const auto block = static_cast<double>(channel.noise.block);
  std::vector<double> t;
  for (Eigen::Index b = 0; b < channel.noise.variance.cols(); ++b)
    t.push_back(grid_seconds(result, (static_cast<double>(b) + 0.5) * block - 0.5));
  const auto add = [&](const std::string& name, const Eigen::Ref<const Eigen::RowVectorXd>& variance) -> report::Line& {
    std::vector<double> sd;
    for (Eigen::Index b = 0; b < variance.size(); ++b) sd.push_back(shown(c, std::sqrt(variance(b))));
    return report::add_line(panel.plot(), name, curve(t, sd));
  };
  for (std::size_t k = 0; k < config.imus.size(); ++k) {
    add(config.imus[k].name, channel.noise.variance.row(static_cast<Eigen::Index>(k)));
    if (channel.predicted.size() == 0) continue;
    report::Line& line = add(config.imus[k].name + ", predicted", channel.predicted.row(static_cast<Eigen::Index>(k)));
    line.style = report::Line::Style::kDashed;
    line.hidden = k > 0;
  }
  Eigen::RowVectorXd merged(channel.noise.variance.cols());
  for (Eigen::Index b = 0; b < merged.size(); ++b) {
    const auto first = b * static_cast<Eigen::Index>(channel.noise.block);
    const Eigen::Index count =
        b + 1 == merged.size() ? channel.variance.size() - first : static_cast<Eigen::Index>(channel.noise.block);
    merged(b) = channel.variance.segment(first, count).mean();
  }
  report::Line& line = add("merged", merged);
  line.tone = report::Tone::kSmoothed;
  line.width_px = 2.0;
  return panel;
}

report::Boxes::Box box_of(std::vector<double> values, double y) {
  std::ranges::sort(values);
  const auto q = [&](double p) { return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1))]; };
  return {y, q(0.05), q(0.25), q(0.5), q(0.75), q(0.95)};
}

/// The paper's Fig. 10: residuals of the sensors against their mean.
report::Panel box_panel(const ArrayConfig& config, const SynthResult& result) {
  report::Panel panel =
      report::grid_panel("boxes", "Residuals", 3, "Of each sensor against the mean of all, Eq. (11): 5, 25, 50, 75 and 95 %.");
  for (int c = 0; c < array::kChannels; ++c) {
    const Eigen::MatrixXd y = array::residuals(result.assembly.levelled, c);
    report::Plot plot;
    plot.title = channel_name(c);
    plot.x = {"residual", unit_of(c), report::Axis::Scale::kLinear, {}, {}};
    plot.y = {"", "", report::Axis::Scale::kLinear, {}, {}};
    report::Boxes boxes;
    boxes.label = "residuals";
    for (Eigen::Index k = 0; k < y.rows(); ++k) {
      std::vector<double> values;
      for (const double value : y.row(k)) values.push_back(shown(c, value));
      boxes.boxes.push_back(box_of(std::move(values), static_cast<double>(k)));
      plot.y.ticks.push_back({static_cast<double>(k), config.imus[static_cast<std::size_t>(k)].name});
    }
    plot.boxes.push_back(std::move(boxes));
    panel.plots.push_back(std::move(plot));
  }
  return panel;
}

report::Table model_table(const ArrayConfig& config, const SynthResult& result) {
  report::Table table{
      "models",
      "ARMA-GARCH models",
      "Quasi-maximum likelihood. Tests of the standardised residuals: large p where the model leaves nothing; long "
      "records find the smallest remainder.",
      {},
      {}};
  table.columns = {{"channel", "", false}, {"IMU", "", false},  {"alpha", "", false}, {"beta", "", false},
                   {"gamma + delta", ""},  {"Ljung-Box p", ""}, {"ARCH-LM p", ""},    {"Jarque-Bera p", ""}};
  const auto list = [](const std::vector<double>& values) {
    std::vector<std::string> words;
    for (const double value : values) words.push_back(decimals(value, 3));
    return joined(words, ", ");
  };
  for (int c = 0; c < array::kChannels; ++c) {
    const array::MergedChannel& channel = result.channels[static_cast<std::size_t>(c)];
    for (std::size_t k = 0; k < channel.models.size(); ++k) {
      const noise::ArmaGarch& model = channel.models[k].model;
      const array::ModelTests& tests = channel.tests[k];
      table.rows.push_back(
          cells({channel_name(c), config.imus[k].name, list(model.alpha), list(model.beta), decimals(model.persistence(), 4),
                 number(tests.white.p_value, 2), number(tests.even.p_value, 2), number(tests.normal.p_value, 2)}));
    }
  }
  return table;
}

}  // namespace

report::Section array_noise_section(const ArrayConfig& config, const SynthResult& result) {
  report::Section section{"noise", "Noise", "", {}, {}, {}};
  section.tables.push_back(noise_table(config, result));
  if (!result.against_reference.empty()) section.tables.push_back(reference_table(config, result));
  if (!result.channels.front().models.empty()) section.tables.push_back(model_table(config, result));
  section.panels.push_back(box_panel(config, result));
  for (int c = 0; c < array::kChannels; ++c) section.panels.push_back(tracking_panel(config, result, c));
  return section;
}

}  // namespace coast::jobs
