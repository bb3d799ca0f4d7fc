#include "oracles/files/three_mf.h"

#include <gmpxx.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "oracles/base/text_reader.h"
#include "oracles/files/xml_text.h"

namespace tetproof::oracles {
namespace {

// ---------------------------------------------------------------------------------------- the zip

class Archive {
 public:
  Archive(const std::string& path, std::string_view bytes) : path_(path) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
    if (source == nullptr) throw std::bad_alloc();
    // Checked for consistency: also for a name that is twice in it.
    archive_.reset(zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &error));
    if (archive_ == nullptr) {
      zip_source_free(source);
      fail("an archive that cannot be read: " + std::string(zip_error_strerror(&error)));
    }
    check_names();
  }

  bool contains(const std::string& name) const { return place_of(name) >= 0; }

  std::string contents(const std::string& name) const {
    const zip_int64_t place = place_of(name);
    if (place < 0) fail("there is no " + name + " in the archive");
    zip_stat_t entry;
    const auto index = static_cast<zip_uint64_t>(place);
    if (zip_stat_index(archive_.get(), index, 0, &entry) != 0 ||
        entry.size / 1032 > entry.comp_size) {
      fail(name + " has a size that cannot be");
    }
    check_unpacked(path_ + ": " + name, entry.comp_size, entry.size);
    std::string text(entry.size, '\0');
    const std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file(
        zip_fopen_index(archive_.get(), index, 0), &zip_fclose);
    char beyond = 0;  // the sum of the bytes is looked at where they end
    if (file == nullptr ||
        zip_fread(file.get(), text.data(), text.size()) != static_cast<zip_int64_t>(text.size()) ||
        zip_fread(file.get(), &beyond, 1) != 0) {
      fail(name + " is damaged or encrypted");
    }
    return text;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw ReadError(path_ + ": " + reason);
  }
  // Names that differ in case, or in a slash in front, name one part.
  void check_names() const {
    std::set<std::string> names;
    for (zip_int64_t n = 0; n < zip_get_num_entries(archive_.get(), 0); ++n) {
      std::string name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(n), 0);
      for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      if (!names.insert(name.substr(name.starts_with('/') ? 1 : 0)).second) {
        fail("two files of the name " + name);
      }
    }
  }
  // Without regard to case, and to a slash in front; negative if there is none.
  zip_int64_t place_of(const std::string& name) const {
    const std::string plain = name.substr(name.starts_with('/') ? 1 : 0);
    const zip_int64_t place = zip_name_locate(archive_.get(), plain.c_str(), ZIP_FL_NOCASE);
    return place >= 0 ? place
                      : zip_name_locate(archive_.get(), ("/" + plain).c_str(), ZIP_FL_NOCASE);
  }

  const std::string& path_;
  std::unique_ptr<zip_t, decltype(&zip_discard)> archive_{nullptr, &zip_discard};
};

// -------------------------------------------------------------------------------------- the model

using Matrix = std::array<double, 12>;

class ModelReader {
 public:
  ModelReader(const std::string& path, std::string_view bytes)
      : path_(path), archive_(path, bytes) {}

  Polyhedron read() {
    const std::string root = root_name();
    for (const XmlElement* build : part(root).all(prefix(root) + "build")) {
      for (const XmlElement* item : build->all(prefix(root) + "item")) place(root, *item, {});
    }
    if (labels_.size() == 1) label_by_material();
    if (std::ranges::all_of(surface_.labels, [](auto label) { return label == 1; })) {
      surface_.labels.clear();
    }
    return std::move(surface_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw ReadError(path_ + ": " + reason);
  }

  std::string root_name() const {
    if (archive_.contains("_rels/.rels")) {
      const std::string text = archive_.contents("_rels/.rels");
      const XmlElement relations = read_xml(path_ + ", _rels/.rels", text);
      for (const XmlElement& relation : relations.children) {
        const std::string *type = relation.attribute("Type"),
                          *target = relation.attribute("Target");
        if (type == nullptr || target == nullptr || relation.value("TargetMode") == "External") {
          continue;
        }
        if (type->ends_with("/3dmanufacturing/2013/01/3dmodel")) return *target;
      }
    }
    return "3D/3dmodel.model";
  }

  const XmlElement& part(const std::string& name) {
    auto model = parts_.find(name);
    if (model == parts_.end()) {
      const std::string text = archive_.contents(name);
      model = parts_.emplace(name, read_xml(path_ + ", " + name, text)).first;
      check_extensions(model->second);
    }
    return model->second;
  }
  // A model says what must be understood of it.
  void check_extensions(const XmlElement& model) const {
    std::istringstream required(model.value("requiredextensions"));
    for (std::string prefix; required >> prefix;) {
      const std::string* space = model.attribute("xmlns:" + prefix);
      if (space == nullptr ||
          !(space->ends_with("/production/2015/06") || space->ends_with("/material/2015/02"))) {
        fail("the model requires the extension " + prefix);
      }
    }
  }
  // The prefix of the names in a part, up to the colon.
  std::string prefix(const std::string& name) {
    const std::string& root = part(name).name;
    const std::size_t colon = root.find(':');
    return colon == std::string::npos ? "" : root.substr(0, colon + 1);
  }

  const std::string& needed(const XmlElement& element, const std::string& name) const {
    const std::string* value = element.attribute(name);
    if (value == nullptr) fail(element.name + " without " + name);
    return *value;
  }
  double real(const XmlElement& element, const char* name) const {
    return TextReader(path_, needed(element, name), '\0').number();
  }

  std::optional<Matrix> matrix_of(const XmlElement& element) const {
    const std::string* text = element.attribute("transform");
    if (text == nullptr) return {};
    TextReader reader(path_, *text, '\0');
    Matrix matrix;
    for (double& x : matrix) x = reader.number();
    reader.expect_nothing();
    return matrix;
  }

  // The object that an item or a component names; `matrices` are those around it.
  void place(const std::string& from, const XmlElement& user, std::vector<Matrix> matrices) {
    if (matrices_deep_ > 40 || ++placed_ > 1100000) fail("components without an end");
    std::string name = from;
    for (const auto& [key, value] : user.attributes) {
      if (key.ends_with(":path")) name = value;
    }
    if (const auto matrix = matrix_of(user)) matrices.push_back(*matrix);
    const std::string& id = needed(user, "objectid");
    const XmlElement& object = find_object(name, id);
    const std::string* type = object.attribute("type");
    if (type != nullptr && *type != "model" && *type != "surface") return;
    ++matrices_deep_;
    for (const XmlElement* components : object.all(prefix(name) + "components")) {
      for (const XmlElement* component : components->all(prefix(name) + "component")) {
        place(name, *component, matrices);
      }
    }
    --matrices_deep_;
    for (const XmlElement* mesh : object.all(prefix(name) + "mesh")) {
      add_mesh(name, id, *mesh, matrices);
    }
  }

  const XmlElement& find_object(const std::string& name, const std::string& id) {
    for (const XmlElement* resources : part(name).all(prefix(name) + "resources")) {
      for (const XmlElement* object : resources->all(prefix(name) + "object")) {
        if (needed(*object, "id") == id) return *object;
      }
    }
    fail("there is no object " + id + " in " + name);
  }

  void add_mesh(const std::string& name, const std::string& id, const XmlElement& mesh,
                const std::vector<Matrix>& matrices) {
    const auto first = static_cast<std::int64_t>(surface_.vertices.size());
    for (const XmlElement* list : mesh.all(prefix(name) + "vertices")) {
      for (const XmlElement* vertex : list->all(prefix(name) + "vertex")) {
        Position p = {real(*vertex, "x"), real(*vertex, "y"), real(*vertex, "z")};
        for (auto m = matrices.rbegin(); m != matrices.rend(); ++m) p = moved(p, *m);
        surface_.vertices.push_back(p);
      }
    }
    const std::uint64_t count = surface_.vertices.size() - static_cast<std::size_t>(first);
    const bool turned = mirrored(matrices);
    std::int32_t label = 0;
    const XmlElement& object = find_object(name, id);
    const auto modifiers = modifiers_of(id);
    std::uint64_t number = 0;
    for (const XmlElement* list : mesh.all(prefix(name) + "triangles")) {
      for (const XmlElement* triangle : list->all(prefix(name) + "triangle")) {
        const std::uint64_t own = number++;
        if (std::ranges::any_of(modifiers, [own](const auto& range) {
              return range[0] <= own && own <= range[1];
            })) {
          continue;
        }
        std::array<Index, 3> corners;
        for (int k = 0; k < 3; ++k) {
          const std::string key = std::string("v") + "123"[k];
          corners[k] = static_cast<Index>(
              TextReader(path_, needed(*triangle, key), '\0').index(0, count) + first);
        }
        if (turned) std::swap(corners[1], corners[2]);
        if (label == 0) {
          const auto next = static_cast<std::int32_t>(labels_.size() + 1);
          label = labels_.emplace(std::pair(name, id), next).first->second;
        }
        surface_.triangles.push_back(corners);
        surface_.polygons.push_back(static_cast<Index>(surface_.polygons.size()));
        surface_.labels.push_back(label);
        materials_.push_back(material_of(name, object, *triangle));
      }
    }
  }

  // The first and the last triangle of each volume that PrusaSlicer, in a file of its own, calls
  // something else than a part of the object. It writes one model.
  std::vector<std::array<std::uint64_t, 2>> modifiers_of(const std::string& id) const {
    std::vector<std::array<std::uint64_t, 2>> result;
    const std::string file = "Metadata/Slic3r_PE_model.config";
    if (parts_.size() != 1 || !archive_.contains(file)) return result;
    const std::string text = archive_.contents(file);
    const XmlElement config = read_xml(path_ + ", " + file, text);
    for (const XmlElement* object : config.all("object")) {
      if (needed(*object, "id") != id) continue;
      for (const XmlElement* volume : object->all("volume")) {
        const auto is_other = [](const XmlElement* m) {
          const std::string *key = m->attribute("key"), *value = m->attribute("value");
          return key != nullptr && *key == "volume_type" && value != nullptr &&
                 *value != "ModelPart";
        };
        if (std::ranges::none_of(volume->all("metadata"), is_other)) continue;
        const auto end = [&](const char* name) {
          return std::uint64_t{
              TextReader(path_, needed(*volume, name), '\0').index(0, 0xffffffffU)};
        };
        result.push_back({end("firstid"), end("lastid")});
      }
    }
    return result;
  }

  // The numbers of the group and of its member that a triangle names, or the object for it; empty
  // if that is nothing, or neither a base material nor a colour.
  std::string material_of(const std::string& name, const XmlElement& object,
                          const XmlElement& triangle) {
    const bool own = triangle.attribute("p1") != nullptr;
    const std::string* index = own ? triangle.attribute("p1") : object.attribute("pindex");
    const std::string* group = own ? triangle.attribute("pid") : nullptr;
    if (group == nullptr) group = object.attribute("pid");
    if (index == nullptr || group == nullptr) return {};
    const std::optional<std::size_t> size = size_of_group(name, *group);
    if (!size) return {};
    const std::uint32_t member = TextReader(path_, *index, '\0').index(0, *size);
    return *group + " " + std::to_string(member);
  }

  std::optional<std::size_t> size_of_group(const std::string& name, const std::string& id) {
    for (const XmlElement* resources : part(name).all(prefix(name) + "resources")) {
      for (const XmlElement& group : resources->children) {
        const std::string* own = group.attribute("id");
        if (own == nullptr || *own != id) continue;
        if (group.name == prefix(name) + "basematerials") {
          return group.all(prefix(name) + "base").size();
        }
        for (const auto& [key, value] : part(name).attributes) {
          if (!key.starts_with("xmlns:") || !value.ends_with("/material/2015/02")) continue;
          const std::string colours = key.substr(6) + ":";
          if (group.name == colours + "colorgroup") return group.all(colours + "color").size();
        }
      }
    }
    return {};
  }

  // For a single object: labels by material, in the order of use.
  void label_by_material() {
    std::map<std::string, std::int32_t> labels;
    for (std::size_t t = 0; t < materials_.size(); ++t) {
      const auto next = static_cast<std::int32_t>(labels.size() + 1);
      surface_.labels[t] = labels.emplace(materials_[t], next).first->second;
    }
  }

  // Row vectors, from the left; products and sums are rounded one after the other, as formats.md
  // says.
  static Position moved(const Position& p, const Matrix& m) {
    Position q{};
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = p[0] * m[i];
      for (std::size_t k = 1; k < 3; ++k) sum += p[k] * m[3 * k + i];
      q[i] = sum + m[9 + i];
    }
    return q;
  }

  static bool mirrored(const std::vector<Matrix>& matrices) {
    bool result = false;
    for (const Matrix& m : matrices) {
      std::array<mpq_class, 9> a;
      for (std::size_t i = 0; i < 9; ++i) a[i] = m[i];
      const mpq_class determinant = a[0] * (a[4] * a[8] - a[5] * a[7]) -
                                    a[1] * (a[3] * a[8] - a[5] * a[6]) +
                                    a[2] * (a[3] * a[7] - a[4] * a[6]);
      result = result != (determinant < 0);
    }
    return result;
  }

  const std::string path_;
  Archive archive_;
  std::map<std::string, XmlElement> parts_;
  std::map<std::pair<std::string, std::string>, std::int32_t> labels_;
  std::vector<std::string> materials_;  // of the triangles
  int matrices_deep_ = 0, placed_ = 0;
  Polyhedron surface_;
};

}  // namespace

bool is_zip(std::string_view bytes) {
  return bytes.starts_with("PK\x03\x04");
}

Polyhedron read_three_mf(const std::string& path, std::string_view bytes) {
  return ModelReader(path, bytes).read();
}

}  // namespace tetproof::oracles
