// 3MF (3D Manufacturing Format, core specification 1.3): a zip archive with a model in XML. Of the
// extensions that a file may require, production (models in several parts) is read, and of
// materials the colours.
#include <array>
#include <compare>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesher/io/readers.h"
#include "mesher/io/text.h"
#include "mesher/io/xml.h"
#include "mesher/io/zip.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::io {
namespace {

constexpr std::string_view kModelType = "/3dmanufacturing/2013/01/3dmodel",
                           kUsualModel = "3D/3dmodel.model";
constexpr std::string_view kNamespaces = "http://schemas.microsoft.com/3dmanufacturing/";
// What PrusaSlicer's own file says about the objects of its only model.
constexpr const char* kSlicerConfig = "Metadata/Slic3r_PE_model.config";
constexpr std::string_view kProduction = "production/2015/06", kMaterials = "material/2015/02";

// Rows m00 m01 m02, m10 ..., of a matrix that multiplies (x y z 1) from the right.
using Transform = std::array<double, 12>;
using Point = std::array<double, 3>;

// Each coordinate with the rounding of three products and three sums, from left to right.
Point transformed(const Point& p, const Transform& m) {
  Point q;
  for (std::size_t i = 0; i < 3; ++i) {
    q[i] = ((p[0] * m[i] + p[1] * m[3 + i]) + p[2] * m[6 + i]) + m[9 + i];
  }
  return q;
}

// Does it make a mirror image? Exact.
bool mirrors(const Transform& m) {
  return predicates::orient3d_sign({0, 0, 0}, {m[0], m[1], m[2]}, {m[3], m[4], m[5]},
                                   {m[6], m[7], m[8]}) < 0;
}

// An object to be placed: a component of another one, or an item of the build.
struct Placement {
  std::string part;  // in which the object is; empty: this one
  std::uint64_t object = 0;
  std::optional<Transform> transform;
};

// A base material or a colour: a member of a group of the model; no group: none, or something else.
struct Material {
  static constexpr std::uint32_t kNoGroup = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t group = kNoGroup, index = 0;
  auto operator<=>(const Material&) const = default;
};

struct Object {
  std::string type, name;
  std::optional<std::uint64_t> materials_id;
  Material material;                // of triangles without their own
  std::vector<Material> materials;  // of the triangles
  std::vector<Point> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Placement> components;
};

struct Model {
  std::string unit;
  std::vector<std::vector<std::string>> material_names;  // by group
  std::map<std::uint64_t, Object> objects;
  std::vector<Placement> build;
};

// One model of the package.
class ModelReader {
 public:
  ModelReader(std::string_view text, Polling& polling) : tags_(text, polling) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
      fail({}, "text in UTF-16 is not read");
    }
  }

  Model read() {
    while (tags_.next()) {
      if (tags_.begins()) begin_element();
      if (tags_.ends()) end_element();
    }
    if (!open_.empty()) tags_.fail("the file ends within an element " + in_quotes(open_.back()));
    if (!found_) tags_.fail("no model");
    return std::move(model_);
  }

 private:
  // Is the current element `name`, of the core specification, in `parent`, so deep?
  bool is(std::size_t depth, std::string_view parent, std::string_view name) const {
    return open_.size() == depth && (depth == 0 || own(open_.back()) == parent) &&
           own(tags_.name()) == name;
  }
  // Without the prefix that the model has; empty if the prefix is another one.
  std::string_view own(std::string_view name) const {
    if (!name.starts_with(prefix_)) return {};
    name.remove_prefix(prefix_.size());
    return name.find(':') == std::string_view::npos ? name : std::string_view();
  }

  void begin_element() {
    const std::string_view name = tags_.name();
    if (open_.empty()) {
      if (found_) tags_.fail("a second root of the XML");
      begin_model();
    } else if (is(2, "resources", "basematerials") || is_colour(2, "colorgroup")) {
      begin_group();
    } else if (is(3, "basematerials", "base") && own(open_[1]) == "resources") {
      add_material("name");
    } else if (is_colour(3, "color")) {
      add_material("color");
    } else if (is(2, "resources", "object")) {
      begin_object();
    } else if (is(5, "vertices", "vertex") && object_ != nullptr) {
      object_->vertices.push_back({coordinate("x"), coordinate("y"), coordinate("z")});
    } else if (is(5, "triangles", "triangle") && object_ != nullptr) {
      object_->triangles.push_back({corner("v1"), corner("v2"), corner("v3")});
      object_->materials.push_back(material("p1", object_->material));
    } else if (is(4, "components", "component") && object_ != nullptr) {
      object_->components.push_back(placement());
    } else if (is(2, "build", "item")) {
      model_.build.push_back(placement());
    }
    open_.push_back(name);
  }

  void end_element() {
    if (open_.empty() || open_.back() != tags_.name()) {
      tags_.fail("an element ends that did not begin here: " + in_quotes(tags_.name()));
    }
    open_.pop_back();
    if (is(2, "resources", "object") && object_ != nullptr) end_object();
  }

  void begin_model() {
    found_ = true;
    const std::size_t colon = tags_.name().find(':');
    if (colon != std::string_view::npos) prefix_ = tags_.name().substr(0, colon + 1);
    if (own(tags_.name()) != "model") tags_.fail("no model, but " + in_quotes(tags_.name()));
    std::map<std::string_view, std::string_view> spaces;  // by prefix
    tags_.each_attribute([&](std::string_view name, std::string_view value) {
      if (name.starts_with("xmlns:")) spaces[name.substr(6)] = value;
    });
    for (const auto& [prefix, space] : spaces) {
      if (space == std::string(kNamespaces) + std::string(kProduction)) {
        path_attribute_ = std::string(prefix) + ":path";
      }
      if (space == std::string(kNamespaces) + std::string(kMaterials)) {
        colour_prefix_ = std::string(prefix) + ":";
      }
    }
    model_.unit = tags_.attribute("unit").value_or("millimeter");
    TextLines required(tags_.attribute("requiredextensions").value_or(""), Comments::none);
    std::string_view prefix;
    while (required.next_token_anywhere(prefix)) {
      std::string_view space = spaces.contains(prefix) ? spaces.at(prefix) : prefix;
      if (space.starts_with(kNamespaces)) space.remove_prefix(kNamespaces.size());
      if (space != kProduction && space != kMaterials) {
        tags_.fail("the model requires the extension " + in_quotes(space) + ", which is not read");
      }
    }
  }

  void begin_object() {
    const auto id = number<std::uint64_t>("id");
    const auto [at, fresh] = model_.objects.try_emplace(id);
    if (!fresh) tags_.fail("a second object " + std::to_string(id));
    object_ = &at->second;
    object_->type = tags_.attribute("type").value_or("model");
    object_->name = xml_text(tags_.attribute("name").value_or(""));
    if (tags_.attribute("pid")) object_->materials_id = number<std::uint64_t>("pid");
    object_->material = material("pindex", {});
  }

  // Is the current element `name`, of the extension for materials, so deep in the resources?
  bool is_colour(std::size_t depth, std::string_view name) const {
    return open_.size() == depth && own(open_[1]) == "resources" && !colour_prefix_.empty() &&
           tags_.name() == colour_prefix_ + std::string(name) &&
           (depth == 2 || open_[2] == colour_prefix_ + "colorgroup");
  }

  void begin_group() {
    const auto id = number<std::uint64_t>("id");
    const auto next = static_cast<std::uint32_t>(model_.material_names.size());
    if (!groups_.try_emplace(id, next).second) {
      tags_.fail("a second group of materials " + std::to_string(id));
    }
    model_.material_names.emplace_back();
  }

  void add_material(std::string_view name) {
    model_.material_names.back().push_back(xml_text(tags_.attribute(name).value_or("")));
  }

  // What the current element's attribute of that name means, with its own group or the object's;
  // corners may have others. Only an attribute that is there counts.
  Material material(std::string_view index_name, Material otherwise) const {
    if (!tags_.attribute(index_name)) return otherwise;
    const auto index = number<std::uint32_t>(index_name);
    if (!tags_.attribute("pid") && !object_->materials_id) return {};
    const auto group = groups_.find(tags_.attribute("pid") ? number<std::uint64_t>("pid")
                                                           : *object_->materials_id);
    if (group == groups_.end()) return {};
    const std::size_t size = model_.material_names[group->second].size();
    if (index >= size) {
      tags_.fail("there is no " + std::string(index_name) + " " + std::to_string(index) +
                 " among " + std::to_string(size) + " materials");
    }
    return {group->second, index};
  }

  void end_object() {
    for (const auto& triangle : object_->triangles) {
      for (const std::uint32_t v : triangle) {
        if (v >= object_->vertices.size()) {
          tags_.fail("vertex index out of range: " + std::to_string(v) + " of " +
                     std::to_string(object_->vertices.size()));
        }
      }
    }
    object_ = nullptr;
  }

  std::string_view need(std::string_view name) const {
    const auto value = tags_.attribute(name);
    if (!value) {
      tags_.fail("an element " + in_quotes(tags_.name()) + " without " + std::string(name));
    }
    return *value;
  }
  template <class T>
  T number(std::string_view name) const {
    T value{};
    const std::string_view text = need(name);
    if (!parse_integer(text, value)) tags_.fail("bad " + std::string(name) + " " + in_quotes(text));
    return value;
  }
  double real(std::string_view text) const {
    double value = 0;
    const NumberStatus status = parse_double(text, value);
    if (status == NumberStatus::malformed) tags_.fail("bad number " + in_quotes(text));
    if (status == NumberStatus::not_finite) tags_.fail("non-finite number " + in_quotes(text));
    return value;
  }
  double coordinate(std::string_view name) const { return real(need(name)); }
  std::uint32_t corner(std::string_view name) const { return number<std::uint32_t>(name); }

  Placement placement() const {
    Placement result;
    result.object = number<std::uint64_t>("objectid");
    if (!path_attribute_.empty()) result.part = tags_.attribute(path_attribute_).value_or("");
    const auto text = tags_.attribute("transform");
    if (!text) return result;
    TextLines numbers(*text, Comments::none);
    std::string_view token;
    std::size_t n = 0;
    result.transform.emplace();
    for (; numbers.next_token_anywhere(token); ++n) {
      if (n < 12) (*result.transform)[n] = real(token);
    }
    if (n != 12) tags_.fail("a transform of " + std::to_string(n) + " numbers, not 12");
    return result;
  }

  XmlTags tags_;
  std::vector<std::string_view> open_;  // elements, from the root
  std::string_view prefix_;             // of the core specification, with its colon
  std::string path_attribute_;          // of the extension for production; empty: not declared
  std::string colour_prefix_;           // of that for materials, with its colon
  std::map<std::uint64_t, std::uint32_t> groups_;  // of materials, by their numbers in the file
  Model model_;
  Object* object_ = nullptr;  // that the current element is in
  bool found_ = false;
};

// An object in the eyes of PrusaSlicer: its triangles are those of several volumes, some of which
// only change how others are printed.
struct SlicedObject {
  struct Volume {
    std::uint64_t first = 0, last = 0;  // triangles
    std::string type = "ModelPart";
  };
  std::string name;
  std::vector<Volume> volumes;
};

std::map<std::uint64_t, SlicedObject> read_slicer_config(const std::string& text,
                                                         Polling& polling) {
  std::map<std::uint64_t, SlicedObject> objects;
  SlicedObject* object = nullptr;
  SlicedObject::Volume* volume = nullptr;
  XmlTags tags(text, polling);
  const auto number = [&](std::string_view name) {
    std::uint64_t value = 0;
    const std::string_view written = tags.attribute(name).value_or("");
    if (!parse_integer(written, value))
      tags.fail("bad " + std::string(name) + " " + in_quotes(written));
    return value;
  };
  while (tags.next()) {
    if (tags.name() == "object") {
      object = tags.begins() ? &objects[number("id")] : nullptr;
      volume = nullptr;
    } else if (tags.name() == "volume" && object != nullptr) {
      volume = nullptr;
      if (!tags.begins()) continue;
      object->volumes.push_back({.first = number("firstid"), .last = number("lastid")});
      volume = &object->volumes.back();
    } else if (tags.name() == "metadata" && tags.begins() && object != nullptr) {
      const std::string_view key = tags.attribute("key").value_or("");
      const std::string value = xml_text(tags.attribute("value").value_or(""));
      if (volume == nullptr && key == "name") object->name = value;
      if (volume != nullptr && key == "volume_type") volume->type = value;
    }
  }
  return objects;
}

class Package {
 public:
  Package(std::string_view bytes, Polling& polling, SurfaceBuilder& builder)
      : archive_(bytes, polling), polling_(polling), builder_(builder) {}

  void read() {
    const std::string root = root_part();
    const Model& model = part(root);
    builder_.note("coordinates are in the unit " + in_quotes(model.unit));
    if (model.build.empty()) fail({}, "the model builds nothing");
    read_slicer_names();
    for (const Placement& item : model.build) place(root, item, {}, 0);
    for (const Use& use : uses_) add(use);
    const std::size_t labels = one_object() ? materials_.size() : objects_.size();
    if (labels < 2) return builder_.forget_labels();
    builder_.note(std::to_string(labels) + (one_object() ? " materials" : " objects") +
                  ", labelled in the order of their use from 1");
  }

 private:
  // An object where it is placed.
  struct Use {
    const Model* model;
    const Object* object;
    std::uint64_t id;
    std::vector<const Transform*> transforms;
  };

  static constexpr std::size_t kDeepest = 32;
  // So that components of components of components end.
  static constexpr std::uint64_t kMostPlacements = std::uint64_t{1} << 20;

  // Reads a part of the package; an error names it.
  template <class Read>
  auto read_part(const std::string& name, const Read& read) {
    if (!archive_.contains(name)) fail({}, "the package has no part " + in_quotes(name));
    const std::string text = archive_.read(name);
    try {
      return read(text);
    } catch (const ParseError& error) {
      const bool placed = error.position.unit != Position::Unit::none;
      fail({},
           "in " + name + (placed ? ", " + describe(error.position) : "") + ": " + error.reason);
    }
  }

  void read_slicer_names() {
    if (!archive_.contains(kSlicerConfig)) return;
    sliced_ = read_part(
        kSlicerConfig, [&](const std::string& text) { return read_slicer_config(text, polling_); });
  }

  std::string root_part() {
    const std::string relations = "_rels/.rels";
    std::string target;
    if (archive_.contains(relations)) {
      read_part(relations, [&](const std::string& text) {
        XmlTags tags(text, polling_);
        while (tags.next()) {
          if (tags.name() != "Relationship" || !target.empty()) continue;
          if (!tags.attribute("Type").value_or("").ends_with(kModelType) ||
              tags.attribute("TargetMode").value_or("") == "External") {
            continue;
          }
          target = xml_text(tags.attribute("Target").value_or(""));
        }
        return 0;
      });
    }
    return target.empty() ? std::string(kUsualModel) : target;
  }

  Model& part(const std::string& name) {
    const auto found = parts_.find(name);
    if (found != parts_.end()) return found->second;
    Model model = read_part(
        name, [&](const std::string& text) { return ModelReader(text, polling_).read(); });
    if (!parts_.empty() && model.unit != parts_.begin()->second.unit) {
      fail({}, "the parts of the package have different units");
    }
    return parts_.emplace(name, std::move(model)).first->second;
  }

  // `transforms`: those of the object's user, the last one first.
  void place(const std::string& from, const Placement& placement,
             std::vector<const Transform*> transforms, std::size_t depth) {
    if (depth > kDeepest || ++placements_ > kMostPlacements) {
      fail({}, "components that are nested too deep, or too often");
    }
    polling_.poll(100);
    const std::string& name = placement.part.empty() ? from : placement.part;
    Model& model = part(name);
    const auto found = model.objects.find(placement.object);
    if (found == model.objects.end()) {
      fail({}, "there is no object " + std::to_string(placement.object) + " in " + name);
    }
    const Object& object = found->second;
    if (object.type != "model" && object.type != "surface") {
      builder_.warn("objects of the type " + in_quotes(object.type) + " are left out");
      return;
    }
    if (placement.transform) transforms.push_back(&*placement.transform);
    for (const Placement& component : object.components) {
      place(name, component, transforms, depth + 1);
    }
    if (object.triangles.empty()) return;
    objects_.try_emplace(&object, static_cast<std::int32_t>(objects_.size() + 1));
    uses_.push_back({&model, &object, placement.object, std::move(transforms)});
  }

  bool one_object() const { return objects_.size() == 1; }

  // Objects tell triangles apart, and if there is but one, its materials do.
  std::int32_t label_of(const Use& use, std::size_t triangle) {
    const Object& object = *use.object;
    if (!one_object()) return objects_.at(&object);
    const Material material = object.materials[triangle];
    const auto [at, fresh] =
        materials_.try_emplace(material, static_cast<std::int32_t>(materials_.size() + 1));
    if (fresh && material.group != Material::kNoGroup) {
      builder_.name_label(at->second, use.model->material_names[material.group][material.index]);
    }
    return at->second;
  }

  // What PrusaSlicer says about an object, if anything.
  const SlicedObject* sliced(const Use& use) const {
    const auto found = sliced_.find(use.id);
    return found == sliced_.end() || parts_.size() > 1 ? nullptr : &found->second;
  }

  std::string name_of(const Use& use) const {
    if (!use.object->name.empty()) return use.object->name;
    const SlicedObject* told = sliced(use);
    if (told != nullptr && !told->name.empty()) return told->name;
    return "object " + std::to_string(use.id);
  }

  // Triangles of volumes that are not part of the solid.
  std::vector<bool> left_out(const Use& use) {
    std::vector<bool> result(use.object->triangles.size(), false);
    const SlicedObject* told = sliced(use);
    if (told == nullptr) return result;
    for (const SlicedObject::Volume& volume : told->volumes) {
      if (volume.type == "ModelPart") continue;
      builder_.warn("volumes of the type " + in_quotes(volume.type) + " are left out");
      for (std::uint64_t t = volume.first; t <= volume.last && t < result.size(); ++t) {
        result[t] = true;
      }
    }
    return result;
  }

  void add(const Use& use) {
    const Object& object = *use.object;
    const auto& transforms = use.transforms;
    if (!one_object()) builder_.name_label(objects_.at(&object), name_of(use));
    const std::vector<bool> no_part = left_out(use);
    bool mirrored = false;
    for (const Transform* transform : transforms) mirrored ^= mirrors(*transform);
    const std::uint64_t first = builder_.vertex_count();
    for (Point p : object.vertices) {
      for (auto t = transforms.rbegin(); t != transforms.rend(); ++t) p = transformed(p, **t);
      builder_.add_vertex(p[0], p[1], p[2], {});
    }
    for (std::size_t t = 0; t < object.triangles.size(); ++t) {
      if (no_part[t]) continue;
      const auto& [a, b, c] = object.triangles[t];
      const auto corner = [&](std::uint32_t v) { return static_cast<std::uint32_t>(first + v); };
      const std::array corners = {corner(a), corner(mirrored ? c : b), corner(mirrored ? b : c)};
      builder_.add_polygon(corners, label_of(use, t), {});
    }
  }

  ZipArchive archive_;
  Polling& polling_;
  SurfaceBuilder& builder_;
  std::map<std::string, Model> parts_;
  std::map<std::uint64_t, SlicedObject> sliced_;
  std::vector<Use> uses_;
  std::map<const Object*, std::int32_t> objects_;  // in use, with their labels
  std::map<Material, std::int32_t> materials_;     // the same, of the only object
  std::uint64_t placements_ = 0;
};

}  // namespace

// Names of files are not compressed, and at the end of the archive they are all together.
bool looks_like_3mf(std::string_view data) {
  constexpr std::size_t kEnd = std::size_t{1} << 16U;
  return is_zip(data) && data.substr(data.size() - std::min(data.size(), kEnd)).find(".model") !=
                             std::string_view::npos;
}

void read_3mf(std::string_view data, Polling& polling, SurfaceBuilder& builder) {
  Package(data, polling, builder).read();
}

}  // namespace delmesher::io
