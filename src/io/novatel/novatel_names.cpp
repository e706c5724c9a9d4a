#include "novatel_names.hpp"

#include <algorithm>
#include <array>

namespace coast::io {

namespace {

/// OEM7 Commands and Logs Reference Manual, messages by ID; OEM6 names where they differ.
struct NovAtelLogName {
  std::uint32_t id;
  std::string_view name;
  bool read = false;
};
constexpr std::array kNovAtelLogNames = {
    NovAtelLogName{1, "LOG"},
    NovAtelLogName{5, "LOGLIST"},
    NovAtelLogName{novatel::kGpsEphem, "GPSEPHEM", true},
    NovAtelLogName{novatel::kIonUtc, "IONUTC", true},
    NovAtelLogName{16, "CLOCKMODEL"},
    NovAtelLogName{novatel::kRawGpsSubframe, "RAWGPSSUBFRAME", true},
    NovAtelLogName{37, "VERSION"},
    NovAtelLogName{novatel::kRawEphem, "RAWEPHEM", true},
    NovAtelLogName{novatel::kBestPos, "BESTPOS", true},
    NovAtelLogName{novatel::kRange, "RANGE", true},
    NovAtelLogName{novatel::kPsrPos, "PSRPOS", true},
    NovAtelLogName{48, "SATVIS"},
    NovAtelLogName{72, "PORTSTATS"},
    NovAtelLogName{73, "ALMANAC"},
    NovAtelLogName{74, "RAWALM"},
    NovAtelLogName{83, "TRACKSTAT"},
    NovAtelLogName{93, "RXSTATUS"},
    NovAtelLogName{94, "RXSTATUSEVENT"},
    NovAtelLogName{96, "MATCHEDPOS"},
    NovAtelLogName{novatel::kBestVel, "BESTVEL", true},
    NovAtelLogName{novatel::kPsrVel, "PSRVEL", true},
    NovAtelLogName{101, "TIME"},
    NovAtelLogName{128, "RXCONFIG"},
    NovAtelLogName{novatel::kRangeCmp, "RANGECMP", true},
    NovAtelLogName{novatel::kRtkPos, "RTKPOS", true},
    NovAtelLogName{172, "NAVIGATE"},
    NovAtelLogName{174, "PSRDOP"},
    NovAtelLogName{175, "REFSTATION"},
    NovAtelLogName{181, "MARKPOS"},
    NovAtelLogName{206, "VALIDMODELS"},
    NovAtelLogName{novatel::kRtkVel, "RTKVEL", true},
    NovAtelLogName{novatel::kMarkTime, "MARKTIME", true},
    NovAtelLogName{241, "BESTXYZ"},
    NovAtelLogName{263, "INSATT"},
    NovAtelLogName{264, "INSATTS"},
    NovAtelLogName{265, "INSPOS"},
    NovAtelLogName{266, "INSPOSS"},
    NovAtelLogName{267, "INSVEL"},
    NovAtelLogName{novatel::kRawImu, "RAWIMU", true},
    NovAtelLogName{270, "PASSCOM2"},
    NovAtelLogName{287, "RAWWAASFRAME"},
    NovAtelLogName{319, "INSSPDS"},
    NovAtelLogName{320, "INSCOV"},
    NovAtelLogName{321, "INSCOVS"},
    NovAtelLogName{324, "INSVELS"},
    NovAtelLogName{novatel::kRawImuS, "RAWIMUS", true},
    NovAtelLogName{389, "VEHICLEBODYROTATION"},
    NovAtelLogName{407, "RAWGPSWORD"},
    NovAtelLogName{novatel::kBestGpsPos, "BESTGPSPOS", true},
    NovAtelLogName{novatel::kBestGpsVel, "BESTGPSVEL", true},
    NovAtelLogName{novatel::kInsPva, "INSPVA", true},
    NovAtelLogName{novatel::kInsPvaS, "INSPVAS", true},
    NovAtelLogName{novatel::kSetImuType, "SETIMUTYPE", true},
    NovAtelLogName{615, "MARK2POS"},
    NovAtelLogName{novatel::kMark2Time, "MARK2TIME", true},
    NovAtelLogName{622, "TIMEDWHEELDATA"},
    NovAtelLogName{718, "GLOALMANAC"},
    NovAtelLogName{719, "GLOCLOCK"},
    NovAtelLogName{novatel::kGloEphemeris, "GLOEPHEMERIS", true},
    NovAtelLogName{726, "BESTUTM"},
    NovAtelLogName{792, "GLORAWEPHEM"},
    NovAtelLogName{novatel::kCorrImuData, "CORRIMUDATA", true},
    NovAtelLogName{novatel::kCorrImuDataS, "CORRIMUDATAS", true},
    NovAtelLogName{971, "HEADING"},
    NovAtelLogName{973, "RAWSBASFRAME"},
    NovAtelLogName{novatel::kMark1Pva, "MARK1PVA", true},
    NovAtelLogName{novatel::kMark2Pva, "MARK2PVA", true},
    NovAtelLogName{novatel::kMark3Time, "MARK3TIME", true},
    NovAtelLogName{novatel::kMark4Time, "MARK4TIME", true},
    NovAtelLogName{novatel::kMark3Pva, "MARK3PVA", true},
    NovAtelLogName{novatel::kMark4Pva, "MARK4PVA", true},
    NovAtelLogName{1121, "GALCLOCK"},
    NovAtelLogName{novatel::kGalEphemeris, "GALEPHEMERIS", true},
    NovAtelLogName{1127, "GALIONO"},
    NovAtelLogName{novatel::kMark1Time, "MARK1TIME", true},
    NovAtelLogName{1163, "PSRDOP2"},
    NovAtelLogName{1194, "BESTSATS"},
    NovAtelLogName{novatel::kRangeCmp2, "RANGECMP2", true},
    NovAtelLogName{novatel::kGalInavEphemeris, "GALINAVEPHEMERIS", true},
    NovAtelLogName{novatel::kGalFnavEphemeris, "GALFNAVEPHEMERIS", true},
    NovAtelLogName{novatel::kQzssRawSubframe, "QZSSRAWSUBFRAME", true},
    NovAtelLogName{1331, "QZSSRAWEPHEM"},
    NovAtelLogName{1335, "HEADING2"},
    NovAtelLogName{novatel::kQzssEphemeris, "QZSSEPHEMERIS", true},
    NovAtelLogName{1347, "QZSSIONUTC"},
    NovAtelLogName{novatel::kImuRateCorrImuS, "IMURATECORRIMUS", true},
    NovAtelLogName{1413, "GALFNAVRAWPAGE"},
    NovAtelLogName{1414, "GALINAVRAWWORD"},
    NovAtelLogName{novatel::kBestGnssPos, "BESTGNSSPOS", true},
    NovAtelLogName{novatel::kBestGnssVel, "BESTGNSSVEL", true},
    NovAtelLogName{novatel::kRawImuX, "RAWIMUX", true},
    NovAtelLogName{novatel::kRawImuSX, "RAWIMUSX", true},
    NovAtelLogName{novatel::kInsPvaX, "INSPVAX", true},
    NovAtelLogName{novatel::kPppPos, "PPPPOS", true},
    NovAtelLogName{novatel::kPppVel, "PPPVEL", true},
    NovAtelLogName{1695, "BDSRAWNAVSUBFRAME"},
    NovAtelLogName{novatel::kBdsEphemeris, "BDSEPHEMERIS", true},
    NovAtelLogName{1825, "INSUPDATESTATUS"},
    NovAtelLogName{novatel::kInsConfig, "INSCONFIG", true},
    NovAtelLogName{novatel::kRangeCmp4, "RANGECMP4", true},
    NovAtelLogName{2051, "INSSTDEV"},
    NovAtelLogName{2052, "INSSTDEVS"},
    NovAtelLogName{2264, "CORRIMUS"},
    NovAtelLogName{novatel::kRangeCmp5, "RANGECMP5", true},
};

}  // namespace

std::string_view novatel_log_name(std::uint32_t id) {
  const auto found = std::ranges::find(kNovAtelLogNames, id, &NovAtelLogName::id);
  return found == kNovAtelLogNames.end() ? std::string_view() : found->name;
}

std::uint32_t novatel_log_id(std::string_view name) {
  const auto found = std::ranges::find(kNovAtelLogNames, name, &NovAtelLogName::name);
  return found == kNovAtelLogNames.end() ? 0 : found->id;
}

bool reads_novatel_log(std::uint32_t id) {
  const auto found = std::ranges::find(kNovAtelLogNames, id, &NovAtelLogName::id);
  return found != kNovAtelLogNames.end() && found->read;
}

}  // namespace coast::io
