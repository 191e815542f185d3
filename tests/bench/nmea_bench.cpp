// How fast sentences become values, and whole streams become measurements.
//   GNSS receivers send 5 to 100 sentences a second; a recording replayed at full speed sends all.

#include <string>

#include <benchmark/benchmark.h>

#include "gnss/decoder.hpp"
#include "gnss/epoch.hpp"
#include "gnss/nmea_encode.hpp"

namespace {

using namespace roverd;

/// One second of a 5 Hz RTK receiver: GGA RMC VTG GST HDT.
std::string second_of(int second) {
  std::string out;
  for (int i = 0; i < 5; ++i) {
    gnss::Gga gga;
    gga.time_s = second + i * 0.2;
    gga.lat = 58.378020 + second * 1e-6;
    gga.lon = 26.728900 + i * 1e-6;
    gga.quality = 4;
    gga.sats = 17;
    gga.hdop = 0.6;
    gga.alt_msl_m = 58.312;
    gga.geoid_sep_m = 21.705;
    gga.dgps_age_s = 1.2;
    gga.station = 42;
    gnss::Rmc rmc;
    rmc.time_s = gga.time_s;
    rmc.active = true;
    rmc.lat = gga.lat;
    rmc.lon = gga.lon;
    rmc.speed_kn = 1.944;
    rmc.course_deg = 40.0;
    rmc.date = gnss::Date{std::chrono::year{2026}, std::chrono::month{3}, std::chrono::day{1}};
    rmc.mode = 'R';
    gnss::Vtg vtg;
    vtg.course_true_deg = 40.0;
    vtg.speed_kn = 1.944;
    vtg.mode = 'R';
    gnss::Gst gst;
    gst.time_s = gga.time_s;
    gst.rms_m = 1.9;
    gst.lat_sd_m = gst.lon_sd_m = 0.02;
    gst.alt_sd_m = 0.03;
    gnss::Hdt hdt;
    hdt.heading_deg = 40.0;
    out += encode(gga) + encode(rmc) + encode(vtg) + encode(gst) + encode(hdt);
  }
  return out;
}

std::string stream() {
  std::string out;
  for (int second = 0; second < 400; ++second) out += second_of(second);
  return out;
}

base::Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

void BM_ParseGga(benchmark::State& state) {
  const std::string line =
      "$GNGGA,101530.20,3352.1234567,S,15112.7654321,W,4,17,0.6,58.312,M,21.705,M,1.2,0042*6A";
  for (auto _ : state) benchmark::DoNotOptimize(gnss::parse_line(line));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_ParseGga);

/// Bytes to typed sentences. items_per_second is sentences a second.
void BM_DecodeStream(benchmark::State& state) {
  const std::string text = stream();
  std::uint64_t sentences = 0;
  for (auto _ : state) {
    gnss::Decoder decoder;
    decoder.feed(bytes_of(text), base::Time{},
                 [](const gnss::Sentence& s, base::Time) { benchmark::DoNotOptimize(&s); });
    sentences += decoder.counts().used;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(sentences));
  state.SetBytesProcessed(static_cast<std::int64_t>(text.size()) * state.iterations());
}
BENCHMARK(BM_DecodeStream);

/// Bytes to measurements, in the small chunks of a serial port.
void BM_StreamToMeasurements(benchmark::State& state) {
  const std::string text = stream();
  std::uint64_t sentences = 0;
  std::uint64_t measurements = 0;
  for (auto _ : state) {
    gnss::Decoder decoder;
    gnss::EpochAssembler epochs({}, [&](const base::Measurement&) { ++measurements; });
    for (std::size_t at = 0; at < text.size(); at += 64) {
      decoder.feed(bytes_of(text).subspan(at, std::min<std::size_t>(64, text.size() - at)),
                   base::Time{}, [&](const gnss::Sentence& s, base::Time t) { epochs.add(s, t); });
    }
    sentences += decoder.counts().used;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(sentences));
  state.counters["measurements"] =
      benchmark::Counter(static_cast<double>(measurements), benchmark::Counter::kIsRate);
}
BENCHMARK(BM_StreamToMeasurements);

}  // namespace
