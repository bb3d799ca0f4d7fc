// The readers of the single formats. Each throws ParseError; parse_surface chooses among them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "mesher/io/surface_builder.h"

namespace delmesher::io {

void read_off(std::string_view text, SurfaceBuilder& builder);
// `planar`: a vertex may have two coordinates, the third is then 0; polylines become lines.
void read_obj(std::string_view text, bool planar, SurfaceBuilder& builder);
void read_stl(std::string_view data, SurfaceBuilder& builder);
void read_ply(std::string_view data, SurfaceBuilder& builder);
void read_3mf(std::string_view data, Polling& polling, SurfaceBuilder& builder);

enum class TetgenKind : std::uint8_t { smesh, poly };
// `node_file` returns the text of the .node file that stands beside one without points.
using NodeFile = std::function<std::optional<std::string>()>;
void read_tetgen(std::string_view text, TetgenKind kind, const NodeFile& node_file,
                 SurfaceBuilder& builder);

// By content: an OFF header keyword, the PLY magic, an STL's exact binary size or "solid", an
// archive of zip with a model in it.
bool looks_like_off(std::string_view data);
bool looks_like_ply(std::string_view data);
bool looks_like_stl(std::string_view data);
bool looks_like_3mf(std::string_view data);
bool looks_like_obj(std::string_view data);

}  // namespace delmesher::io
