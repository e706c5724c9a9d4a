#pragma once
// Accuracies that satellites state by an index. Private to the room.

namespace coast::io {

/// Nominal value of the user range accuracy index of GPS, QZSS and BeiDou, m (IS-GPS-200N, 20.3.3.3.1.3; BeiDou B1I ICD 3.0).
[[nodiscard]] double ura_metres(int index);
/// Signal-in-space accuracy of Galileo, m (OS SIS ICD 2.1, table 89); 0 where the satellite gives none.
[[nodiscard]] double sisa_metres(int index);

}  // namespace coast::io
