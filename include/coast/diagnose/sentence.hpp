#pragma once
// Findings in plain words, for people who know the vehicle and not the catalogue.

#include <string>

#include "coast/diagnose/diagnosis.hpp"

namespace coast::diagnose {

/// Size and sigma in the unit that the field uses for it: centimetres, milliseconds, deg/h, mg, .. Digits end with the second
/// one of the sigma if its first is 1, otherwise with the first. @param sd  0: unknown, three digits
[[nodiscard]] std::string plain_size(double value, double sd, std::string_view unit, Site site);

/// Of one time of an effect that repeats, as of any other finding.
[[nodiscard]] std::string sentence_of_one(const Finding& finding);
/// "The antenna is 28 +- 1 cm further right than stated.", with the time if it begins at some time, and a second sentence if an
/// IMU of this grade hardly errs so much (thirty times what is usual). Of an effect that happened several times: how often, and
/// the largest size.
[[nodiscard]] std::string sentence(const Finding& finding);
/// Likewise, of noise and converters.
[[nodiscard]] std::string sentence(const NoiseFinding& finding);
/// What is gained by all findings together: the drift of outages with and without them, and whether the paired differences
/// show more than chance (two sigmas). Empty if the mission has no two outages, or if nothing was found.
[[nodiscard]] std::string consequence(const Diagnosis& diagnosis);

}  // namespace coast::diagnose
