// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/random.hpp"
#include "core/config/visit.hpp"
#include "core/model/kinematics.hpp"
#include "core/model/measurement.hpp"
#include "core/model/vehicle.hpp"

namespace headland {

/// When a sensor reads, and how its readings come through.
struct ReadingConfig {
  bool enabled = true;
  double rate_hz = 0.0;
  double latency_s = 0.0;
  double dropout_probability = 0.0;
  double outage_rate_hz = 0.0;
  double outage_s = 0.0;

  template <class V>
  void visit(V& v) {
    v("enabled", enabled, "Whether the vehicle has this sensor");
    v("rate_hz", rate_hz, config::Range{0.0, 1e4}, "Readings per second [Hz]; 0: every tick");
    v("latency_s", latency_s, config::Range{0.0, 10.0},
      "From the time when a reading was true until it arrives [s]");
    v("dropout_probability", dropout_probability, config::kFraction,
      "Of any single reading to be lost");
    v("outage_rate_hz", outage_rate_hz, config::Range{0.0, 100.0},
      "Outages per second of good reception [Hz], at random times");
    v("outage_s", outage_s, config::Range{0.0, 3600.0},
      "Duration of an outage, in which every reading is lost [s]");
  }
};

/// Spells of worse fixes: a receiver that has lost its fixed ambiguities, or its corrections.
struct WorseFixConfig {
  double rate_hz = 0.0;
  double duration_s = 0.0;
  double error_m = 0.0;

  template <class V>
  void visit(V& v) {
    v("rate_hz", rate_hz, config::Range{0.0, 100.0}, "Spells per second of good fixes [Hz]");
    v("duration_s", duration_s, config::Range{0.0, 3600.0}, "Of a spell [s]");
    v("error_m", error_m, config::kNonNegative,
      "Standard deviation in x and in y of the error that a spell keeps; readings own up to it "
      "[m]");
  }
};

/// Position of base in the map. Good fixes are those with fixed ambiguities.
struct GnssConfig : ReadingConfig {
  double noise_m = 0.0;
  WorseFixConfig float_fix{0.0, 0.0, 0.3};
  WorseFixConfig single_fix{0.0, 0.0, 1.5};
  double multipath_probability = 0.0;
  double multipath_low_m = 5.0;
  double multipath_high_m = 40.0;

  template <class V>
  void visit(V& v) {
    ReadingConfig::visit(v);
    v("noise_m", noise_m, config::kNonNegative,
      "Standard deviation of white noise in x and in y, beside position_accuracy_m [m]");
    v("float_fix", float_fix, "Spells without fixed ambiguities");
    v("single_fix", single_fix, "Spells without corrections");
    v("multipath_probability", multipath_probability, config::kFraction,
      "Of a reading to be far off without owning up to it");
    v("multipath_low_m", multipath_low_m, config::kNonNegative, "It is off by at least this [m]");
    v("multipath_high_m", multipath_high_m, config::kNonNegative, "It is off by at most this [m]");
  }
};

/// Heading in the map: two antennas, a magnetometer.
struct HeadingConfig : ReadingConfig {
  double noise_deg = 0.0;

  template <class V>
  void visit(V& v) {
    ReadingConfig::visit(v);
    v("noise_deg", noise_deg, config::kNonNegative,
      "Standard deviation of white noise, beside heading_noise_deg [deg]");
  }
};

/// Speed of the wheels; of a differential vehicle also their yaw rate, from the wheels of either
/// side.
struct WheelConfig : ReadingConfig {
  double noise_mps = 0.0;
  double scale_error_ratio = 0.0;

  template <class V>
  void visit(V& v) {
    ReadingConfig::visit(v);
    v("noise_mps", noise_mps, config::kNonNegative,
      "Standard deviation of the speed's white noise [m/s]");
    v("scale_error_ratio", scale_error_ratio, config::Range{-0.5, 0.5},
      "Readings are too large by this share: worn or soft tyres");
  }
};

/// Steering angle of an Ackermann vehicle.
struct SteeringSensorConfig : ReadingConfig {
  double noise_deg = 0.0;

  template <class V>
  void visit(V& v) {
    ReadingConfig::visit(v);
    v("noise_deg", noise_deg, config::kNonNegative, "Standard deviation of white noise [deg]");
  }
};

/// Gyroscope.
struct ImuConfig : ReadingConfig {
  double noise_radps = 0.0;
  double bias_radps = 0.0;

  template <class V>
  void visit(V& v) {
    ReadingConfig::visit(v);
    v("noise_radps", noise_radps, config::kNonNegative,
      "Standard deviation of the yaw rate's white noise [rad/s]");
    v("bias_radps", bias_radps, config::Range{-1.0, 1.0}, "Constant error of the yaw rate [rad/s]");
  }
};

/// What a simulated vehicle's sensors get wrong.
struct SensorConfig {
  double position_accuracy_m = 0.0;
  double heading_noise_deg = 0.0;
  GnssConfig gnss;
  HeadingConfig heading;
  WheelConfig wheel;
  SteeringSensorConfig steering;
  ImuConfig imu;

  template <class V>
  void visit(V& v) {
    v("position_accuracy_m", position_accuracy_m, config::kNonNegative,
      "Fixes are off by a uniform error within +- this in x and in y (seed 004) [m]");
    v("heading_noise_deg", heading_noise_deg, config::kNonNegative,
      "Standard deviation of the heading's white noise [deg]");
    v("gnss", gnss, "Position fixes");
    v("heading", heading, "Heading in the map");
    v("wheel", wheel, "Speed of the wheels");
    v("steering", steering, "Steering angle; Ackermann vehicles only");
    v("imu", imu, "Yaw rate of the vehicle");
  }
};

/// What a vehicle's sensors tell of the truth. Each has random streams of its own, for its noise,
/// its drop-outs and its outages, so that no setting changes what another draws. Deterministic for
/// a seed. Does not allocate once as many readings were under way as ever are at a time.
class Sensors {
 public:
  Sensors(const Vehicle& vehicle, const SensorConfig& config, std::uint64_t seed);

  /// Takes the readings due at `now` [s], which never decreases, from the state and the yaw rate
  /// over ground [rad/s] that are true then; returns all that arrive by `now` and have not been
  /// returned before, with the time when each was true and its standard deviation: a uniform error
  /// within +-a has a/sqrt(3), and none is below kLeastDeviation, for weights. Biases and scale
  /// errors are not in it. A sensor reads at its first tick and then at the first tick at or after
  /// each full period; what falls between two calls is never read. The span holds until the next
  /// call.
  std::span<const Measurement> sense(const VehicleState& truth, double yaw_rate, double now);

  /// The whole state with position_accuracy_m and heading_noise_deg: a new fix at every call,
  /// without rate, latency or loss.
  VehicleState fix(const VehicleState& truth);

  static constexpr double kLeastDeviation = 1e-4;

 private:
  // When a sensor reads, and what is under way from it.
  class Channel {
   public:
    Channel(const ReadingConfig& config, std::uint64_t seed, std::string_view name);
    bool due(double now);   // whether it reads at this tick
    bool lost(double now);  // whether what it reads now is lost; once a reading
    void send(const Measurement& reading) { under_way_.push_back(reading); }
    // Moves what has arrived to `arrived`.
    void deliver(double now, std::vector<Measurement>& arrived);
    RandomStream& noise() { return noise_; }

   private:
    double good_time();  // until the next outage [s]

    ReadingConfig config_;
    RandomStream noise_;
    RandomStream dropout_;
    RandomStream outage_;
    bool started_ = false;
    double first_ = 0.0;    // tick
    double periods_ = 0.0;  // since then until the next reading
    double outage_begin_ = 0.0;
    std::vector<Measurement> under_way_;  // in the order of their time
  };

  // Spells of worse fixes, one after the other.
  class WorseFix {
   public:
    WorseFix(const WorseFixConfig& config, std::uint64_t seed, std::string_view name);
    // Of a reading at `now`, which never decreases: its error [m] in a spell, else nullopt.
    std::optional<Point2> error(double now);
    double deviation() const { return config_.error_m; }

   private:
    void plan(double from);  // the next spell after that time

    WorseFixConfig config_;
    RandomStream random_;
    bool started_ = false;
    double begin_ = 0.0;
    Point2 error_{0.0, 0.0};
  };

  void read_position(const VehicleState& truth, double now);
  void read_heading(const VehicleState& truth, double now);
  void read_wheels(const VehicleState& truth, double now);
  void read_steering(const VehicleState& truth, double now);
  void read_yaw_rate(double yaw_rate, double now);

  bool ackermann_;
  double track_width_m_;
  SensorConfig config_;
  RandomStream fix_noise_;
  Channel gnss_;
  WorseFix float_fix_;
  WorseFix single_fix_;
  RandomStream multipath_;
  Channel heading_;
  Channel wheel_;
  Channel steering_;
  Channel imu_;
  std::vector<Measurement> arrived_;
};

}  // namespace headland
