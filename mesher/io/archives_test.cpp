// Archives of zip, and the models in them: 3MF.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "mesher/io/parse_surface.h"
#include "mesher/io/reading.h"
#include "mesher/io/test_archives.h"
#include "mesher/io/zip.h"

namespace delmesher::io::archives_test {
namespace {

std::string error_of(const std::string& bytes, const std::string& name) {
  Polling polling;
  try {
    ZipArchive(bytes, polling).read(name);
  } catch (const ParseError& error) {
    return error.reason;
  }
  return {};
}

TEST(Zip, FilesAreReadByTheirNames) {
  const std::string text(100000, 'x');
  for (const bool wide : {false, true}) {
    const std::string bytes =
        Zip(wide).add("a/B.txt", text).add("empty", "", false).add("c", "stored", false).finish();
    Polling polling;
    ZipArchive archive(bytes, polling);
    EXPECT_TRUE(archive.read("a/B.txt") == text);
    EXPECT_TRUE(archive.read("/A/b.TXT") == text);
    EXPECT_EQ(archive.read("empty"), "");
    EXPECT_EQ(archive.read("c"), "stored");
    EXPECT_FALSE(archive.contains("a"));
  }
}

TEST(Zip, SaysWhatIsWrong) {
  const std::string bytes = Zip().add("a", "some text").finish();
  EXPECT_EQ(error_of(Zip().add("a", "x", true, 1).finish(), "a"), "'a' is encrypted");
  EXPECT_EQ(error_of(Zip().add("a", "x").add("A", "y").finish(), "a"), "two files of the name 'A'");
  std::string changed = bytes;
  changed[34] ^= 8;  // of the compressed text
  EXPECT_NE(error_of(changed, "a"), "");
  changed = bytes;
  changed[bytes.find("PK\x01\x02") + 16] ^= 1;  // the checksum
  EXPECT_EQ(error_of(changed, "a"), "'a' is damaged: its checksum differs");
  changed = bytes;
  changed[bytes.find("PK\x01\x02") + 10] = 12;
  EXPECT_EQ(error_of(changed, "a"), "'a' is compressed in an unknown manner");
  EXPECT_EQ(error_of(bytes.substr(0, 50), "a"), "the archive is cut: its directory is missing");
  EXPECT_EQ(error_of(bytes.substr(10), "a"), "the directory of the archive is damaged");
}

// ------------------------------------------------------------------------------------------- 3MF

using Points = std::vector<std::array<double, 3>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;
const Points kPoints = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1}};
const Triangles kTriangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

TEST(ThreeMf, OneObjectHasNoLabels) {
  const std::string bytes = package(
      model("<object id='7' name='a &lt; b'>" + kTet + "</object>", "<item objectid='7'/>"));
  for (const char* name : {"a.3mf", "a.stl", "-"}) {
    const ReadResult read = parse_surface(bytes, name);
    ASSERT_TRUE(read.ok()) << read.error;
    EXPECT_EQ(read.format, "3MF");
    EXPECT_EQ(read.surface.vertices, kPoints);
    EXPECT_EQ(read.surface.triangles, kTriangles);
    EXPECT_TRUE(read.surface.labels.empty());
    EXPECT_TRUE(read.names.empty());
    EXPECT_EQ(read.notes, std::vector<std::string>{"coordinates are in the unit 'inch'"});
  }
}

const std::string kMaterials =
    "<basematerials id='3'><base name='steel &amp; zinc' displaycolor='#112233'/><base "
    "name='wood'/>"
    "</basematerials><m:colorgroup id='4'><m:color color='#FF0000'/><m:color color='#00FF00FF'/>"
    "</m:colorgroup><m:texture2dgroup id='5' texid='6'/>";
const std::string kNamespace =
    "xmlns:m='http://schemas.microsoft.com/3dmanufacturing/material/2015/02'";

// A tetrahedron whose triangles have these attributes.
std::string painted(const std::array<std::string, 4>& triangles) {
  std::string text = kTet;
  std::size_t at = 0;
  for (const std::string& attributes : triangles) {
    at = text.find("<triangle ", at) + 10;
    const std::size_t end = text.find("/>", at);
    text.replace(at, end - at, text.substr(at, 20) + ' ' + attributes);
  }
  return text;
}

// What means no character stays as it is.
TEST(ThreeMf, CharactersOfNamesMayBeNumbers) {
  const std::pair<const char*, const char*> names[] = {
      {"&#65;&#xe9;&#x20ac;&#x1f600;", "A\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80"},
      {"&#0;&#xd800;&#x110000;&#65x;&#;&bad;&quot;&apos;&gt;&",
       "&#0;&#xd800;&#x110000;&#65x;&#;&bad;\"'>&"}};
  for (const auto& [written, meant] : names) {
    const ReadResult read =
        parse_surface(package(model("<![CDATA[ <object id='7'/> ]]><object id='7' name=\"" +
                                        std::string(written) + "\">" + kTet +
                                        "</object><object id='8'>" + kTet + "</object>",
                                    "<item objectid='7'/><item objectid='8'/>")),
                      "a.3mf");
    ASSERT_TRUE(read.ok()) << read.error;
    EXPECT_EQ(read.names.at(1), meant);
  }
}

// A triangle's own material, else the object's; a group of its own, else the object's.
TEST(ThreeMf, MaterialsOfTheOnlyObjectAreLabels) {
  const auto read = [](const std::string& object, const std::array<std::string, 4>& triangles,
                       const std::string& items = "<item objectid='7'/>") {
    return parse_surface(package(model(kMaterials + "<object id='7' " + object + ">" +
                                           painted(triangles) + "</object>",
                                       items, kNamespace)),
                         "a.3mf");
  };
  const ReadResult own =
      read("", {"pid='4' p1='1'", "", "pid='3' p1='0' p2='1'", "pid='4' p1='1'"});
  ASSERT_TRUE(own.ok()) << own.error;
  EXPECT_EQ(own.surface.labels, (std::vector<std::int32_t>{1, 2, 3, 1}));
  EXPECT_EQ(own.names, (LabelNames{{1, "#00FF00FF"}, {3, "steel & zinc"}}));
  EXPECT_EQ(own.notes.back(), "3 materials, labelled in the order of their use from 1");
  const ReadResult given = read("pid='3' pindex='1'", {"", "p1='0'", "pid='4'", "pid='4' p1='0'"},
                                "<item objectid='7'/><item objectid='7' transform='1 0 0 0 1 0 0 0 "
                                "1 9 0 0'/>");
  ASSERT_TRUE(given.ok()) << given.error;
  EXPECT_EQ(given.surface.labels, (std::vector<std::int32_t>{1, 2, 1, 3, 1, 2, 1, 3}));
  EXPECT_EQ(given.names, (LabelNames{{1, "wood"}, {2, "steel & zinc"}, {3, "#FF0000"}}));
  // One material, and what is not one: a texture, a group without a member, a member without a
  // group.
  EXPECT_TRUE(read("pid='3' pindex='1'", {}).surface.labels.empty());
  EXPECT_TRUE(
      read("", {"pid='5' p1='8'", "pid='3'", "p1='1'", "pid='9' p1='1'"}).surface.labels.empty());
  EXPECT_EQ(read("", {"pid='3' p1='2'"}).error,
            "a.3mf: in /3D/My.model, line 5: there is no p1 2 among 2 materials");
  EXPECT_EQ(
      parse_surface(package(model(kMaterials + "<basematerials id='4'/>", "", kNamespace)), "a.3mf")
          .error,
      "a.3mf: in /3D/My.model, line 5: a second group of materials 4");
}

// A component goes through its own transform, then through that of the item. A mirror image is
// turned inside out, twice mirrored it is not.
TEST(ThreeMf, ItemsAndComponentsArePlaced) {
  const std::string move = "transform='1 0 0 0 1 0 0 0 1 10 20 30'";
  const std::string mirror = "transform=' 2 0 0  0 1 0  0 0 -1  0 0 0 '";
  const ReadResult read = parse_surface(
      package(model("<object id='1' name='part'>" + kTet + "</object><object id='2' type='model'>" +
                        kTet + "</object><object id='3'><components><component objectid='1' " +
                        move + "/><component objectid='2'/></components></object>",
                    "<item objectid='3' " + mirror + "/><item objectid='1'/>")),
      "a.3mf");
  ASSERT_TRUE(read.ok()) << read.error;
  ASSERT_EQ(read.surface.vertices.size(), 12U);
  EXPECT_EQ(read.surface.vertices[1], (std::array<double, 3>{22, 20, -30}));
  EXPECT_EQ(read.surface.vertices[3], (std::array<double, 3>{20, 20, -(0.1 + 30)}));
  EXPECT_EQ(read.surface.vertices[5], (std::array<double, 3>{2, 0, 0}));
  EXPECT_EQ(read.surface.vertices[9], (std::array<double, 3>{1, 0, 0}));
  EXPECT_EQ(read.surface.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(read.surface.triangles[4], (std::array<std::uint32_t, 3>{4, 5, 6}));
  EXPECT_EQ(read.surface.triangles[8], (std::array<std::uint32_t, 3>{8, 10, 9}));
  EXPECT_EQ(read.surface.labels, (std::vector<std::int32_t>{1, 1, 1, 1, 2, 2, 2, 2, 1, 1, 1, 1}));
  EXPECT_EQ(read.names, (LabelNames{{1, "part"}, {2, "object 2"}}));
  const ReadResult twice =
      parse_surface(package(model("<object id='1'>" + kTet +
                                      "</object><object id='3'><components><component "
                                      "objectid='1' " +
                                      mirror + "/></components></object>",
                                  "<item objectid='3' " + mirror + "/>")),
                    "a.3mf");
  ASSERT_TRUE(twice.ok()) << twice.error;
  EXPECT_EQ(twice.surface.triangles, kTriangles);
}

// Models of slicers have their objects in parts of their own.
TEST(ThreeMf, ObjectsMayBeInOtherParts) {
  const std::string other =
      "<c:model unit='inch' xmlns:c='http://schemas.microsoft.com/3dmanufacturing/core/2015/02'>"
      "<c:resources><c:object id='1'><c:mesh><c:vertices><c:vertex x='0' y='0' z='0'/>"
      "<c:vertex x='1' y='0' z='0'/><c:vertex x='0' y='1' z='0'/><c:vertex x='0' y='0' z='.1'/>"
      "<vertex x='9' y='9' z='9'/></c:vertices><c:triangles><c:triangle v1='0' v2='2' v3='1'/>"
      "<c:triangle v1='0' v2='1' v3='3'/><c:triangle v1='1' v2='2' v3='3'/>"
      "<c:triangle v1='2' v2='0' v3='3'/></c:triangles></c:mesh></c:object></c:resources>"
      "</c:model>";
  const std::string root = model(
      "<object id='2'><components><component q:path='/3D/Objects/o.model' objectid='1'/>"
      "</components></object>",
      "<item objectid='2'/>",
      "requiredextensions='q' "
      "xmlns:q='http://schemas.microsoft.com/3dmanufacturing/production/2015/06'");
  const std::string bytes =
      Zip(true).add("3D/3dmodel.model", root).add("3D/Objects/o.model", other).finish();
  const ReadResult read = parse_surface(bytes, "a.3mf");
  ASSERT_TRUE(read.ok()) << read.error;
  EXPECT_EQ(read.surface.vertices, kPoints);
  EXPECT_EQ(read.surface.triangles, kTriangles);
  std::string millimeters = other;
  millimeters.replace(millimeters.find("unit='inch'"), 11, "");
  EXPECT_EQ(parse_surface(
                Zip().add("3D/3dmodel.model", root).add("3D/Objects/o.model", millimeters).finish(),
                "a.3mf")
                .error,
            "a.3mf: the parts of the package have different units");
}

// As PrusaSlicer 2.5 writes it: names, and which triangles are those of modifiers, stand in a file
// beside the model.
TEST(ThreeMf, PrusaSlicersNamesAndModifiers) {
  const std::string models =
      model("<object id='1' type='model'>" + kTet + "</object><object id='2' type='model'>" + kTet +
                "</object><object id='3' name='own' type='model'>" + kTet + "</object>",
            "<item objectid='2'/><item objectid='1'/><item objectid='3'/>");
  const std::string config =
      "<?xml version='1.0' encoding='UTF-8'?>\n<config>\n"
      " <object id='1' instances_count='1'>\n"
      "  <metadata type='object' key='name' value='a &amp; b'/>\n"
      "  <metadata type='object' key='layer_height' value='0.2'/>\n"
      "  <volume firstid='0' lastid='1'>\n"
      "   <metadata type='volume' key='name' value='a volume'/>\n"
      "   <metadata type='volume' key='volume_type' value='ModelPart'/>\n"
      "   <mesh edges_fixed='0'/>\n  </volume>\n"
      "  <volume firstid='2' lastid='2'>\n"
      "   <metadata type='volume' key='volume_type' value='ParameterModifier'/>\n  </volume>\n"
      " </object>\n <object id='3'><metadata type='object' key='name' value='c'/></object>\n"
      "</config>\n";
  const auto with = [&](const std::string& text) {
    return parse_surface(
        Zip().add("3D/3dmodel.model", models).add("Metadata/Slic3r_PE_model.config", text).finish(),
        "a.3mf");
  };
  const ReadResult read = with(config);
  ASSERT_TRUE(read.ok()) << read.error;
  EXPECT_EQ(read.names, (LabelNames{{1, "object 2"}, {2, "a & b"}, {3, "own"}}));
  EXPECT_EQ(read.surface.labels, (std::vector<std::int32_t>{1, 1, 1, 1, 2, 2, 2, 3, 3, 3, 3}));
  EXPECT_EQ(read.surface.triangles[6], (std::array<std::uint32_t, 3>{6, 4, 7}));
  EXPECT_EQ(read.warnings,
            std::vector<std::string>{"volumes of the type 'ParameterModifier' are left out"});
  EXPECT_EQ(with("<config><object id='x'/></config>").error,
            "a.3mf: in Metadata/Slic3r_PE_model.config, line 1: bad id 'x'");
}

TEST(ThreeMf, SupportsAreLeftOut) {
  const ReadResult read = parse_surface(
      package(model(
          "<object id='1'>" + kTet + "</object><object id='2' type='support'>" + kTet + "</object>",
          "<item objectid='2'/><item objectid='1'/>")),
      "a.3mf");
  ASSERT_TRUE(read.ok()) << read.error;
  EXPECT_EQ(read.surface.triangles.size(), 4U);
  EXPECT_EQ(read.warnings, std::vector<std::string>{"objects of the type 'support' are left out"});
}

struct Bad {
  const char* law;
  std::string model;
  const char* error;  // after "a.3mf: "
};
void PrintTo(const Bad& bad, std::ostream* stream) {
  *stream << bad.law;
}

class BadModels : public testing::TestWithParam<Bad> {};

TEST_P(BadModels, AreRefusedInOneLine) {
  const ReadResult read = parse_surface(package(GetParam().model), "a.3mf");
  EXPECT_EQ(read.code, ReadCode::unreadable);
  EXPECT_EQ(read.error, "a.3mf: " + std::string(GetParam().error));
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  text.replace(text.find(what), what.size(), by);
  return text;
}

const std::string kGood =
    model("<object id='1'>\n" + kTet + "\n</object>\n", "<item objectid='1'/>");
std::string nested() {
  std::string objects = "<object id='1'>" + kTet + "</object>";
  for (int i = 2; i < 28; ++i) {
    const std::string component = "<component objectid='" + std::to_string(i - 1) + "'/>";
    objects += "<object id='" + std::to_string(i) + "'><components>" + component + component +
               "</components></object>";
  }
  return model(objects, "<item objectid='27'/>");
}

const Bad kBad[] = {
    {"NoNumber", replaced(kGood, "y='1'", "y='l'"), "in /3D/My.model, line 6: bad number 'l'"},
    {"NotFinite", replaced(kGood, "y='1'", "y='inf'"),
     "in /3D/My.model, line 6: non-finite number 'inf'"},
    {"NoCoordinate", replaced(kGood, "y='1'", ""),
     "in /3D/My.model, line 6: an element 'vertex' without y"},
    {"OutOfRange", replaced(kGood, "v3='1'", "v3='4'"),
     "in /3D/My.model, line 8: vertex index out of range: 4 of 4"},
    {"Negative", replaced(kGood, "v3='1'", "v3='-1'"), "in /3D/My.model, line 6: bad v3 '-1'"},
    {"Twice", replaced(kGood, "</object>", "</object><object id='1'/>"),
     "in /3D/My.model, line 8: a second object 1"},
    {"NoObject", replaced(kGood, "item objectid='1'", "item objectid='3'"),
     "there is no object 3 in /3D/My.model"},
    {"NoItem", replaced(kGood, "<item objectid='1'/>", ""), "the model builds nothing"},
    {"Transform", replaced(kGood, "<item", "<item transform='1 0 0 0 1 0 0 0 1'"),
     "in /3D/My.model, line 10: a transform of 9 numbers, not 12"},
    {"Infinite", replaced(kGood, "<item", "<item transform='1e308 0 0 0 1 0 0 0 1 1e308 0 0'"),
     "non-finite coordinate"},
    {"Extension",
     replaced(kGood, "unit",
              "requiredextensions='s' xmlns:s='http://schemas.microsoft"
              ".com/3dmanufacturing/slice/2015/07' unit"),
     "in /3D/My.model, line 3: the model requires the extension 'slice/2015/07', which is not "
     "read"},
    {"Cut", kGood.substr(0, 400), "in /3D/My.model, line 6: an element without an end"},
    {"CutBetweenElements", kGood.substr(0, 337),
     "in /3D/My.model, line 6: the file ends within an element 'triangles'"},
    {"Crossed", replaced(kGood, "</mesh>", "</object>"),
     "in /3D/My.model, line 7: an element ends that did not begin here: 'object'"},
    {"NoModel", "<html>x</html>", "in /3D/My.model, line 1: no model, but 'html'"},
    {"NoXml", "text", "in /3D/My.model, line 1: no model"},
    {"Doctype", "<!DOCTYPE model [<!ENTITY a 'b'>]>" + kGood,
     "in /3D/My.model, line 1: a document type is not read"},
    {"Utf16", "\xff\xfe<", "in /3D/My.model: text in UTF-16 is not read"},
    {"Cycle", replaced(kGood, kTet, "<components><component objectid='1'/></components>"),
     "components that are nested too deep, or too often"},
    {"TooMany", nested(), "components that are nested too deep, or too often"},
};

INSTANTIATE_TEST_SUITE_P(ThreeMf, BadModels, testing::ValuesIn(kBad),
                         [](const auto& bad) { return std::string(bad.param.law); });

// Cut anywhere or with a bit changed: one line, or the same number of triangles.
TEST(ThreeMf, DamagedPackagesAreRefused) {
  const std::string all = package(kGood);
  std::size_t refused = 0;
  for (std::size_t at = 0; at < all.size(); ++at) {
    std::string changed = all;
    changed[at] = static_cast<char>(changed[at] ^ 1 << at % 8);
    for (const std::string& bytes : {all.substr(0, at), changed}) {
      const ReadResult read = parse_surface(bytes, "a.3mf");
      refused += read.ok() ? 0 : 1;
      EXPECT_EQ(read.error.find_first_of("\r\n"), std::string::npos);
      if (read.ok()) {
        EXPECT_EQ(read.surface.triangles, kTriangles);
      }
    }
  }
  EXPECT_GT(refused, all.size() * 4 / 3);
  EXPECT_EQ(parse_surface(Zip().add("a.txt", "x").finish(), "a.zip").error,
            "a.zip: a zip archive: unpack it first (unzip)");
  EXPECT_EQ(parse_surface(Zip().add("a.txt", "x").finish(), "a.3mf").error,
            "a.3mf: the package has no part '3D/3dmodel.model'");
}

}  // namespace
}  // namespace delmesher::io::archives_test
