#include "engine/study/spread_band.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/study/spread_sampler.hpp"

#include <cmath>
#include <cstring>
#include <numeric>

namespace flyball {
namespace {

BandPoint samples_at(const Mechanism& mechanism, const std::string& address, const BandPlace& place,
                     std::span<const Tolerance> tolerances, const std::vector<SpreadName>& outputs,
                     SpreadOptions options) {
  BandPoint point{place.number, {}, {}};
  Mechanism there = mechanism;
  try {
    set_parameter(there, address, place.number);
    validate(there);
  } catch (const SceneError&) { // no curve goes there
    return point;
  }
  options.start = place.start;
  SpreadSampler sampler(there, tolerances, outputs, options);
  if (!sampler.regular()) return point;
  std::vector<std::vector<double>> followed(outputs.size());
  std::vector<double> values(outputs.size());
  for (std::size_t i = 0; i < options.samples; ++i) {
    const SampleFate fate = sampler.make(i, values);
    ++point.counts[static_cast<std::size_t>(fate)];
    if (fate != SampleFate::followed && fate != SampleFate::unstable) continue;
    for (std::size_t k = 0; k < values.size(); ++k)
      if (std::isfinite(values[k])) followed[k].push_back(values[k]);
  }
  for (std::vector<double>& each : followed)
    point.outputs.push_back(spread_statistics(each));
  return point;
}

// Of a point: whether there are samples, the counts, the statistics.
template <class Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
template <class Value>
void take(std::string_view& bytes, Value& value) {
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
}

} // namespace

std::size_t BandPoint::samples() const {
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

std::size_t BandPoint::others() const {
  return samples() - counts[static_cast<std::size_t>(SampleFate::followed)];
}

SpreadBand spread_band(const Mechanism& mechanism, const std::string& address,
                       std::span<const BandPlace> places, std::span<const Tolerance> tolerances,
                       const SpreadOptions& options, WorkSharing& sharing) {
  SpreadBand band;
  const std::vector<SpreadName> outputs = spread_outputs(mechanism);
  for (const SpreadName& output : outputs)
    band.outputs.push_back(output.name);
  SharedWork work;
  work.count = places.size();
  work.cancel = options.cancel;
  if (options.progress) work.progress = options.progress;
  work.maker = [&] {
    return [&](std::size_t from, std::size_t to) {
      const Interruptible scope(options.cancel);
      std::string block;
      try {
        for (std::size_t i = from; i < to; ++i) {
          const BandPoint point = samples_at(mechanism, address, places[i], tolerances, outputs, options);
          append(block, point.outputs.size());
          append(block, point.counts);
          for (const SpreadStatistics& each : point.outputs)
            append(block, each);
        }
      } catch (const Interrupted&) { // nothing more is taken
      }
      return block;
    };
  };
  work.take = [&](std::size_t from, std::size_t to, std::string_view block) {
    for (std::size_t i = from; i < to && !block.empty(); ++i) {
      BandPoint point{places[i].number, {}, {}};
      std::size_t count = 0;
      take(block, count);
      take(block, point.counts);
      point.outputs.resize(count);
      for (SpreadStatistics& each : point.outputs)
        take(block, each);
      band.points.push_back(std::move(point));
    }
  };
  sharing.run(work);
  band.cancelled = band.points.size() < places.size();
  return band;
}

} // namespace flyball
