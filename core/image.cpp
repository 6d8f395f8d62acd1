#include "core/image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/atomic_file.h"
#include "core/cut_png.h"
#include "core/error.h"

namespace zonal {
namespace {

constexpr const char* kPrefix = "zonal:";
constexpr int kLargestSide = 1 << 16;  // pixels; more is a damaged header
constexpr double kLargestImage = 4e9;  // floats of all channels

enum class Format { exr, png };

Format format_of(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension == ".exr") return Format::exr;
  if (extension == ".png") return Format::png;
  throw SceneError(fmt::format("{}: found extension \"{}\", expected .exr or .png", file, extension));
}

/// One line of what OpenImageIO complained about.
std::string one_line(std::string text) {
  text = text.substr(0, text.find('\n'));
  return text.empty() ? "no reason given" : text;
}

// ---- channels of an EXR
// -------------------------------------------------------------------------------------------

/// "albedo.R" is channel "R" of layer "albedo"; "R" is a channel of "".
struct ChannelName {
  std::string layer, channel;
  explicit ChannelName(const std::string& name) {
    const size_t dot = name.rfind('.');
    layer = dot == std::string::npos ? "" : name.substr(0, dot);
    channel = dot == std::string::npos ? name : name.substr(dot + 1);
  }
  /// Files sort channels by name; pixels want R G B A and X Y Z.
  int rank() const {
    static const std::string order = "RrXx|GgYy|BbZz|Aa";
    const size_t found = channel.size() == 1 ? order.find(channel) : std::string::npos;
    return found == std::string::npos ? 4 : static_cast<int>(found / 5);
  }
};

std::string channel_name(const std::string& layer, int channels, int channel) {
  const char* names = layer == "normal" ? "XYZ" : layer == "depth" ? "Z" : channels == 1 ? "Y" : "RGBA";
  const std::string letter(1, names[channel]);
  return layer.empty() ? letter : layer + "." + letter;
}

std::map<std::string, Image> split_layers(const OIIO::ImageSpec& spec, const std::vector<float>& pixels) {
  std::map<std::string, std::vector<int>> channels;
  for (int c = 0; c < spec.nchannels; ++c) channels[ChannelName(spec.channelnames[c]).layer].push_back(c);
  std::map<std::string, Image> layers;
  for (auto& [name, indices] : channels) {
    std::stable_sort(indices.begin(), indices.end(), [&](int a, int b) {
      return ChannelName(spec.channelnames[a]).rank() < ChannelName(spec.channelnames[b]).rank();
    });
    Image image(spec.width, spec.height, static_cast<int>(indices.size()));
    const size_t count = size_t(spec.width) * spec.height;
    for (size_t i = 0; i < count; ++i) {
      for (size_t c = 0; c < indices.size(); ++c) {
        image.pixels[i * indices.size() + c] = pixels[i * spec.nchannels + indices[c]];
      }
    }
    layers[name] = std::move(image);
  }
  // Other programs put the picture itself into a layer ("ViewLayer.Combined.R"): take the first coloured one.
  if (!layers.count("")) {
    const auto colour =
        std::find_if(layers.begin(), layers.end(), [](auto& l) { return l.second.channels >= 3; });
    layers[""] = Image(colour == layers.end() ? layers.begin()->second : colour->second);
  }
  return layers;
}

// ---- writing
// ------------------------------------------------------------------------------------------------------

/// Pixels as the file holds them, with their description.
struct Encoded {
  OIIO::ImageSpec spec;
  std::vector<float> floats;         // EXR
  std::vector<unsigned char> bytes;  // PNG
};

const Image& radiance_of(const std::string& file, const ImageFile& image) {
  const auto found = image.layers.find("");
  if (found == image.layers.end() || found->second.pixels.empty()) {
    throw SceneError(fmt::format("{}: cannot be written: the picture has no pixels", file));
  }
  return found->second;
}

Encoded encode_exr(const ImageFile& image, const Image& radiance) {
  // The radiance first, then the layers in their order.
  std::vector<std::string> names;
  std::vector<std::pair<const Image*, int>> sources;
  for (const auto& [name, layer] : image.layers) {
    if (layer.width != radiance.width || layer.height != radiance.height) {
      throw SceneError(fmt::format("layer \"{}\" is {}x{}, the picture {}x{}", name, layer.width,
                                   layer.height, radiance.width, radiance.height));
    }
    for (int c = 0; c < std::min(layer.channels, 4); ++c) {
      names.push_back(channel_name(name, layer.channels, c));
      sources.emplace_back(&layer, c);
    }
  }
  Encoded encoded;
  encoded.spec =
      OIIO::ImageSpec(radiance.width, radiance.height, static_cast<int>(names.size()), OIIO::TypeDesc::FLOAT);
  encoded.spec.channelnames = names;
  encoded.spec.attribute("compression", "zip");
  const size_t count = size_t(radiance.width) * radiance.height;
  encoded.floats.resize(count * names.size());
  for (size_t c = 0; c < names.size(); ++c) {
    const auto [layer, channel] = sources[c];
    for (size_t i = 0; i < count; ++i) {
      encoded.floats[i * names.size() + c] = layer->pixels[i * layer->channels + channel];
    }
  }
  return encoded;
}

Encoded encode_png(const Image& radiance, float exposure, bool display_referred) {
  Encoded encoded;
  encoded.spec = OIIO::ImageSpec(radiance.width, radiance.height, 3, OIIO::TypeDesc::UINT8);
  encoded.spec.attribute("oiio:ColorSpace", "sRGB");
  encoded.bytes.reserve(size_t(radiance.width) * radiance.height * 3);
  for (int y = 0; y < radiance.height; ++y) {
    for (int x = 0; x < radiance.width; ++x) {
      const vec3 c = radiance.rgb(x, y);
      for (int k = 0; k < 3; ++k) {
        // fmax answers 0 to NaN: a PNG has no way to show one.
        const float shown =
            display_referred ? std::fmin(std::fmax(c[k], 0.0f), 1.0f) : srgb_encode(c[k] * exposure);
        encoded.bytes.push_back(static_cast<unsigned char>(shown * 255.0f + 0.5f));
      }
    }
  }
  return encoded;
}

}  // namespace

// IEC 61966-2-1. In double, so that white stays 1 exactly.
float srgb_encode(float linear) {
  const double x = std::fmin(std::fmax(linear, 0.0f), 1.0f);
  return static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

float srgb_decode(float encoded) {
  const double x = std::fmin(std::fmax(encoded, 0.0f), 1.0f);
  return static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
}

ImageFile read_image(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw SceneError(fmt::format("{}: no such file", file));
  if (std::filesystem::is_directory(file, error))
    throw SceneError(fmt::format("{}: found a folder, expected an image", file));
  std::ifstream stream(file, std::ios::binary);
  refuse_cut_png(stream, file);
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not multiplied by alpha
  const auto input = OIIO::ImageInput::open(file, &wishes);
  const std::string refusal = OIIO::geterror();  // fetched in any case, or OpenImageIO prints it at exit
  if (!input) throw SceneError(fmt::format("{}: no image that can be read: {}", file, one_line(refusal)));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.width > kLargestSide ||
      spec.height > kLargestSide || double(spec.width) * spec.height * spec.nchannels > kLargestImage) {
    throw SceneError(
        fmt::format("{}: found {}x{} pixels of {} channels, expected an image of a size that can be held",
                    file, spec.width, spec.height, spec.nchannels));
  }
  std::vector<float> pixels(size_t(spec.width) * spec.height * spec.nchannels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data())) {
    throw SceneError(fmt::format("{}: damaged image: {}", file, one_line(input->geterror())));
  }

  ImageFile image;
  // Whole numbers are display values (PNG, JPEG); floating point is radiance (EXR, HDR).
  image.display_referred = !spec.format.is_floating_point();
  if (image.display_referred) {
    Image& radiance = image.layers[""] = Image(spec.width, spec.height, spec.nchannels);
    radiance.pixels = std::move(pixels);
  } else {
    image.layers = split_layers(spec, pixels);
  }
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    const std::string name = attribute.name().string();
    if (name.rfind(kPrefix, 0) == 0)
      image.metadata[name.substr(std::string(kPrefix).size())] = attribute.get_string(0);
  }
  return image;
}

void write_image(const std::string& file, const ImageFile& image, float exposure) {
  const Format format = format_of(file);
  const Image& radiance = radiance_of(file, image);
  Encoded encoded = format == Format::exr ? encode_exr(image, radiance)
                                          : encode_png(radiance, exposure, image.display_referred);
  encoded.spec.attribute("Software", "zonal " ZONAL_VERSION);
  std::map<std::string, std::string> metadata = image.metadata;
  metadata.emplace("exposure", fmt::format("{}", exposure));
  for (const auto& [key, value] : metadata) encoded.spec.attribute(kPrefix + key, value);

  // Encoded in memory first: then one function knows every way in which a disk can fail.
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(format == Format::exr ? "exr" : "png");
  const bool done =
      output && output->set_ioproxy(&memory) && output->open(file, encoded.spec) &&
      (format == Format::exr ? output->write_image(OIIO::TypeDesc::FLOAT, encoded.floats.data())
                             : output->write_image(OIIO::TypeDesc::UINT8, encoded.bytes.data())) &&
      output->close();
  if (!done) {
    throw SceneError(fmt::format("{}: cannot be written: {}", file,
                                 one_line(output ? output->geterror() : OIIO::geterror())));
  }
  write_atomically(file, bytes.data(), bytes.size());
}

void check_writable(const std::string& file) {
  format_of(file);
  check_can_write(file);
}

void check_writable_text(const std::string& file) {
  check_can_write(file);
}

void write_text(const std::string& file, const std::string& text) {
  write_atomically(file, text.data(), text.size());
}

}  // namespace zonal
