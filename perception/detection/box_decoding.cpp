// SPDX-License-Identifier: Apache-2.0
#include "perception/detection/box_decoding.hpp"

#include <algorithm>
#include <cmath>

#include "perception/detection/association.hpp"

namespace headland {
namespace {

constexpr double kLeastProbability = 0.01;  // of a class that the network does not see

ImageBox to_image(const ImageBox& box, const InputMapping& mapping) {
  const auto x = [&](double value) {
    return std::clamp(mapping.offset_x + mapping.scale_x * value, 0.0,
                      static_cast<double>(mapping.width_px));
  };
  const auto y = [&](double value) {
    return std::clamp(mapping.offset_y + mapping.scale_y * value, 0.0,
                      static_cast<double>(mapping.height_px));
  };
  return {x(box.left), y(box.top), x(box.right), y(box.bottom)};
}

ImageBox around(const float* centre_and_size) {
  const double x = centre_and_size[0];
  const double y = centre_and_size[1];
  const double half_width = 0.5 * centre_and_size[2];
  const double half_height = 0.5 * centre_and_size[3];
  return {x - half_width, y - half_height, x + half_width, y + half_height};
}

// The best score of each of our classes, made to add up to 1.
ClassProbability probability_of(const ClassProbability& scores) {
  ClassProbability probability{};
  double sum = 0.0;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    probability[i] = std::max(scores[i], kLeastProbability);
    sum += probability[i];
  }
  for (double& p : probability) p /= sum;
  return probability;
}

// Adds the box if it is sure enough and has an area.
void add(const ImageBox& box, const ClassProbability& scores, const InputMapping& mapping,
         const DecodingConfig& config, std::vector<DetectedBox>& boxes) {
  const double score = std::min(1.0, *std::max_element(scores.begin(), scores.end()));
  if (!(score >= config.least_score_ratio)) return;
  const DetectedBox found{to_image(box, mapping), score, probability_of(scores)};
  if (found.box.area() > 0.0) boxes.push_back(found);
}

template <class Decode>
std::vector<DetectedBox> decode_rows(const NetworkRows& rows, int least_columns,
                                     const DecodingConfig& config, const Decode& decode) {
  std::vector<DetectedBox> boxes;
  if (rows.columns < least_columns) return boxes;
  const auto columns = static_cast<std::size_t>(rows.columns);
  for (std::size_t at = 0; at + columns <= rows.values.size(); at += columns) {
    const std::span<const float> row = rows.values.subspan(at, columns);
    if (std::all_of(row.begin(), row.end(), [](float v) { return std::isfinite(v); })) {
      decode(row, boxes);
    }
  }
  return suppress_doubles(std::move(boxes), config.same_iou_ratio);
}

std::vector<DetectedBox> decode_yolo(const NetworkRows& rows, std::span<const ObjectClass> classes,
                                     const InputMapping& mapping, const DecodingConfig& config,
                                     bool times_objectness) {
  constexpr std::size_t kFirstClass = 5;
  return decode_rows(rows, kFirstClass + 1, config,
                     [&](std::span<const float> row, std::vector<DetectedBox>& boxes) {
                       ClassProbability scores{};
                       const double factor = times_objectness ? row[4] : 1.0;
                       const std::size_t end = std::min(row.size(), kFirstClass + classes.size());
                       for (std::size_t i = kFirstClass; i < end; ++i) {
                         double& score = scores[static_cast<std::size_t>(classes[i - kFirstClass])];
                         score = std::max(score, factor * row[i]);
                       }
                       add(around(row.data()), scores, mapping, config, boxes);
                     });
}

}  // namespace

InputMapping stretched(int width_px, int height_px) {
  return {
      static_cast<double>(width_px), static_cast<double>(height_px), 0.0, 0.0, width_px, height_px};
}

InputMapping letterboxed(int width_px, int height_px, int input_px) {
  const double scale = std::max(width_px, height_px) / static_cast<double>(input_px);
  const double border_x = 0.5 * (input_px - width_px / scale);
  const double border_y = 0.5 * (input_px - height_px / scale);
  return {scale, scale, -scale * border_x, -scale * border_y, width_px, height_px};
}

std::vector<DetectedBox> decode_ssd(const NetworkRows& rows, std::span<const ObjectClass> classes,
                                    const InputMapping& mapping, const DecodingConfig& config) {
  return decode_rows(rows, 7, config,
                     [&](std::span<const float> row, std::vector<DetectedBox>& boxes) {
                       const float place = row[1];
                       if (place < 0.0f || place >= static_cast<float>(classes.size())) return;
                       ClassProbability scores{};
                       const ObjectClass object = classes[static_cast<std::size_t>(place)];
                       scores[static_cast<std::size_t>(object)] = row[2];
                       add({row[3], row[4], row[5], row[6]}, scores, mapping, config, boxes);
                     });
}

std::vector<DetectedBox> decode_darknet(const NetworkRows& rows,
                                        std::span<const ObjectClass> classes,
                                        const InputMapping& mapping, const DecodingConfig& config) {
  return decode_yolo(rows, classes, mapping, config, false);
}

std::vector<DetectedBox> decode_yolo_v5(const NetworkRows& rows,
                                        std::span<const ObjectClass> classes,
                                        const InputMapping& mapping, const DecodingConfig& config) {
  return decode_yolo(rows, classes, mapping, config, true);
}

std::vector<DetectedBox> suppress_doubles(std::vector<DetectedBox> boxes, double same_iou) {
  const auto class_of = [](const DetectedBox& box) {
    return std::max_element(box.probability.begin(), box.probability.end()) -
           box.probability.begin();
  };
  std::stable_sort(boxes.begin(), boxes.end(),
                   [](const DetectedBox& a, const DetectedBox& b) { return a.score > b.score; });
  std::vector<DetectedBox> kept;
  for (const DetectedBox& box : boxes) {
    const bool is_double = std::any_of(kept.begin(), kept.end(), [&](const DetectedBox& surer) {
      return class_of(surer) == class_of(box) && box_overlap(surer.box, box.box) > same_iou;
    });
    if (!is_double) kept.push_back(box);
  }
  return kept;
}

}  // namespace headland
