// SPDX-License-Identifier: Apache-2.0
#include "perception/detection/opencv_detector.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <opencv2/dnn.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "perception/detection/class_names.hpp"

namespace headland {
namespace {

constexpr double kFullScale = 255.0;
constexpr double kBorder = 114.0;  // grey that fills up a letterboxed input

// OpenCV wants memory that it may write to, but only reads it here.
cv::Mat as_matrix(const Image& image) {
  return {image.height_px, image.width_px, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data())};
}

// The image in the middle of a square of `side` pixels.
cv::Mat letterbox(const cv::Mat& pixels, int side) {
  const double scale = static_cast<double>(side) / std::max(pixels.cols, pixels.rows);
  const int width = std::clamp(static_cast<int>(std::lround(scale * pixels.cols)), 1, side);
  const int height = std::clamp(static_cast<int>(std::lround(scale * pixels.rows)), 1, side);
  cv::Mat square(side, side, CV_8UC3, cv::Scalar::all(kBorder));
  cv::Mat inner = square(cv::Rect((side - width) / 2, (side - height) / 2, width, height));
  cv::resize(pixels, inner, inner.size());
  return square;
}

class OpencvDetector : public Detector {
 public:
  OpencvDetector(const NetworkConfig& config, cv::dnn::Net network,
                 std::vector<ObjectClass> classes)
      : config_(config),
        network_(std::move(network)),
        outputs_(network_.getUnconnectedOutLayersNames()),
        classes_(std::move(classes)) {}

 private:
  Result<std::vector<DetectedBox>> do_detect(const Image& image) override {
    try {
      run(image);
    } catch (const cv::Exception& error) {
      return fail(ErrorCode::kInternal, "the network failed: " + std::string(error.what()),
                  "input_px and layers must belong together");
    }
    return decode(image);
  }

  void run(const Image& image) {
    const bool is_boxed = config_.kind == NetworkKind::kYoloV5;
    const cv::Mat pixels =
        is_boxed ? letterbox(as_matrix(image), config_.input_px) : as_matrix(image);
    network_.setInput(cv::dnn::blobFromImage(
        pixels, 1.0 / (kFullScale * config_.spread_ratio), {config_.input_px, config_.input_px},
        cv::Scalar::all(kFullScale * config_.mean_ratio), config_.blue_first, false));
    found_.clear();
    network_.forward(found_, outputs_);
  }

  std::vector<DetectedBox> decode(const Image& image) {
    NetworkRows rows;
    values_.clear();
    for (const cv::Mat& output : found_) {
      if (output.type() != CV_32F || !output.isContinuous() || output.dims < 2) continue;
      const int columns = output.size[output.dims - 1];
      if (rows.columns != 0 && columns != rows.columns) continue;
      rows.columns = columns;
      values_.insert(values_.end(), output.ptr<float>(), output.ptr<float>() + output.total());
    }
    rows.values = values_;
    const InputMapping whole = stretched(image.width_px, image.height_px);
    switch (config_.kind) {
      case NetworkKind::kSsd:
        return decode_ssd(rows, classes_, whole, config_.decoding);
      case NetworkKind::kDarknet:
        return decode_darknet(rows, classes_, whole, config_.decoding);
      case NetworkKind::kYoloV5:
        break;
    }
    return decode_yolo_v5(rows, classes_,
                          letterboxed(image.width_px, image.height_px, config_.input_px),
                          config_.decoding);
  }

  NetworkConfig config_;
  cv::dnn::Net network_;
  std::vector<cv::String> outputs_;
  std::vector<ObjectClass> classes_;
  std::vector<cv::Mat> found_;
  std::vector<float> values_;
};

Result<std::vector<ObjectClass>> read_names(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return fail(ErrorCode::kFileNotFound, "no file " + file, {}, {file, 0, {}});
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return parse_class_names(text);
}

}  // namespace

Result<std::unique_ptr<Detector>> make_opencv_detector(const NetworkConfig& config) {
  for (const std::string& file : {config.weights, config.layers}) {
    if (!file.empty() && !std::filesystem::is_regular_file(file)) {
      return fail(ErrorCode::kFileNotFound, "no file " + file, {}, {file, 0, {}});
    }
  }
  Result<std::vector<ObjectClass>> classes = read_names(config.names);
  if (!classes) return tl::unexpected<Error>(classes.error());
  try {
    cv::dnn::Net network = cv::dnn::readNet(config.weights, config.layers);
    if (!network.empty()) {
      return std::make_unique<OpencvDetector>(config, std::move(network), std::move(*classes));
    }
  } catch (const cv::Exception&) {
    // Said below: OpenCV's own words name its source lines.
  }
  return fail(ErrorCode::kSyntax, "OpenCV cannot load the network " + config.weights,
              "weights and layers of one network, in a format that its DNN module knows",
              {config.weights, 0, {}});
}

Result<Image> read_image(const std::string& file) {
  if (!std::filesystem::is_regular_file(file)) {
    return fail(ErrorCode::kFileNotFound, "no file " + file, {}, {file, 0, {}});
  }
  try {
    const cv::Mat pixels = cv::imread(file, cv::IMREAD_COLOR);
    if (!pixels.empty()) {
      Image image{pixels.cols, pixels.rows, {}};
      image.rgb.resize(3 * pixels.total());
      cv::Mat rgb(pixels.rows, pixels.cols, CV_8UC3, image.rgb.data());
      cv::cvtColor(pixels, rgb, cv::COLOR_BGR2RGB);
      return image;
    }
  } catch (const cv::Exception&) {
    // Said below.
  }
  return fail(ErrorCode::kSyntax, "no image: " + file, "a JPEG or PNG file", {file, 0, {}});
}

}  // namespace headland
