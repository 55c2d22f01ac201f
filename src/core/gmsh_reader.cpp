#include "vacuum_gripper_sim/core/gmsh_reader.h"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "text_lines.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::MatrixXi;

// Element types of the MSH format that matter here.
constexpr int kTriangle3 = 2, kTetrahedron4 = 4, kTriangle6 = 9, kTetrahedron10 = 11;
constexpr int kPointsAndCurves[] = {1, 8, 15, 26, 27, 28};
constexpr int kOtherSurfaces[] = {3, 10, 16, 20, 21, 22, 23, 24, 25, 36, 37};

// Gmsh ends the 10-node tetrahedron with the edges 23, 13; VTK with 13, 23.
constexpr int kGmshNode[10] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

constexpr int kMaxTag = 2147483647;

template <std::size_t n>
bool Contains(const int (&values)[n], const int value) {
  return std::find(std::begin(values), std::end(values), value) != std::end(values);
}

// An entity or a physical group: its dimension and its tag.
using Tag = std::pair<int, int>;
using NodeList = std::vector<std::array<int, 10>>;

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), lines_(path) {}

  TetMesh Read() {
    ReadFormat();
    while (lines_.Next()) {
      const std::string section = lines_.Word("a section");
      if (section == "$PhysicalNames") {
        ReadPhysicalNames();
      } else if (section == "$Entities" && version_ == kVersion41) {
        ReadEntities();
      } else if (section == "$Nodes") {
        version_ == kVersion41 ? ReadNodes41() : ReadNodes22();
      } else if (section == "$Elements") {
        if (nodes_.empty()) lines_.Fail("$Elements comes before $Nodes, must come after");
        CheckGroups();
        version_ == kVersion41 ? ReadElements41() : ReadElements22();
        ExpectEnd("$Elements");
        return Build();
      } else if (section[0] == '$') {
        SkipSection(section);
        continue;
      } else {
        lines_.Fail("found `", section, "`, must be the start of a section such as $Nodes");
      }
      ExpectEnd(section);
    }
    lines_.Fail("the file ends before $Elements");
  }

 private:
  enum Version { kVersion22, kVersion41 };

  void ReadFormat() {
    if (!lines_.Next() || lines_.Rest() != "$MeshFormat") {
      lines_.Fail("not a Gmsh mesh: the file must start with $MeshFormat");
    }
    lines_.NextWithin("$MeshFormat");
    const std::string version = lines_.Word("the version");
    if (version != "2.2" && version != "4.1") {
      lines_.Fail("MSH version is `", version, "`, must be 2.2 or 4.1");
    }
    version_ = version == "4.1" ? kVersion41 : kVersion22;
    if (lines_.Int("the file type") != 0) {
      lines_.Fail("the file is binary, must be ASCII (Gmsh option Mesh.Binary = 0)");
    }
    ExpectEnd("$MeshFormat");
  }

  void ExpectEnd(const std::string& section) {
    const std::string end = "$End" + section.substr(1);
    lines_.NextWithin(section);
    const std::string found = lines_.Rest();
    if (found != end) lines_.Fail("found `", found, "`, must be ", end);
  }

  void SkipSection(const std::string& section) {
    const std::string end = "$End" + section.substr(1);
    do {
      lines_.NextWithin(section);
    } while (lines_.Rest() != end);
  }

  int Count(const char* what) { return lines_.Int(what, 0, kMaxTag); }

  // Room for what takes a line each, but no more than a wrong count in a short file deserves.
  std::size_t Room(const int count) const {
    return static_cast<std::size_t>(std::min(count, lines_.MaxLinesLeft()));
  }

  void ReadPhysicalNames() {
    lines_.NextWithin("$PhysicalNames");
    for (int left = Count("the number of physical names"); left > 0; --left) {
      lines_.NextWithin("$PhysicalNames");
      const int dimension = lines_.Int("a physical group's dimension", 0, 3);
      const int tag = lines_.Int("a physical group's tag");
      std::string name = lines_.Rest();
      if (name.size() < 2 || name.front() != '"' || name.back() != '"') {
        lines_.Fail("a physical group's name is `", name, "`, must be in double quotes");
      }
      if (dimension == 2) surface_names_[tag] = name.substr(1, name.size() - 2);
    }
  }

  void CheckGroups() {
    for (const char* group : {"mount", "cavity"}) {
      const bool found = std::any_of(surface_names_.begin(), surface_names_.end(),
                                     [&](const auto& entry) { return entry.second == group; });
      if (found) continue;
      std::string names;
      for (const auto& entry : surface_names_) {
        names += (names.empty() ? "`" : ", `") + entry.second + "`";
      }
      lines_.Fail("the physical surface `", group, "` is missing; the file has ",
                  names.empty() ? "no named physical surface" : names);
    }
  }

  // Of every entity only the physical groups matter; points lack the upper corner of a box.
  void ReadEntities() {
    lines_.NextWithin("$Entities");
    std::array<int, 4> counts{};
    for (int& count : counts) count = Count("a number of entities");
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (int left = counts[static_cast<std::size_t>(dimension)]; left > 0; --left) {
        lines_.NextWithin("$Entities");
        const int tag = lines_.Int("an entity's tag");
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) lines_.Finite("an entity's box");
        std::vector<int>& groups = groups_of_[{dimension, tag}];
        const int num_groups = lines_.Int("an entity's number of physical groups", 0, kMaxTag);
        for (int k = 0; k < num_groups; ++k) groups.push_back(lines_.Int("a physical group"));
      }
    }
  }

  void AddNode(const int tag) {
    const int index = static_cast<int>(coordinates_.size());
    if (!nodes_.emplace(tag, index).second) lines_.Fail("node ", tag, " is there twice");
    coordinates_.emplace_back();
  }

  void ReadCoordinates(Eigen::Vector3d* x) {
    for (int k = 0; k < 3; ++k) (*x)(k) = lines_.Finite("a coordinate");
  }

  void ReadNodes22() {
    lines_.NextWithin("$Nodes");
    const int count = Count("the number of nodes");
    nodes_.reserve(Room(count));
    for (int i = 0; i < count; ++i) {
      lines_.NextWithin("$Nodes");
      AddNode(lines_.Int("a node's number", 1, kMaxTag));
      ReadCoordinates(&coordinates_.back());
      lines_.ExpectEndOfLine();
    }
  }

  void ReadNodes41() {
    lines_.NextWithin("$Nodes");
    const int num_blocks = Count("the number of node blocks");
    const int num_nodes = Count("the number of nodes");
    nodes_.reserve(Room(num_nodes));
    for (int block = 0; block < num_blocks; ++block) {
      lines_.NextWithin("$Nodes");
      for (const char* what : {"an entity's dimension", "an entity's tag", "the parametric flag"}) {
        lines_.Int(what);
      }
      const int count = Count("a block's number of nodes");
      const std::size_t first = coordinates_.size();
      for (int i = 0; i < count; ++i) {
        lines_.NextWithin("$Nodes");
        AddNode(lines_.Int("a node's number", 1, kMaxTag));
        lines_.ExpectEndOfLine();
      }
      for (std::size_t i = first; i < coordinates_.size(); ++i) {
        lines_.NextWithin("$Nodes");
        ReadCoordinates(&coordinates_[i]);  // parametric coordinates may follow
      }
    }
    if (static_cast<int>(coordinates_.size()) != num_nodes) {
      lines_.Fail("the blocks have ", coordinates_.size(), " nodes, must have ", num_nodes);
    }
  }

  void ReadElements22() {
    lines_.NextWithin("$Elements");
    for (int left = Count("the number of elements"); left > 0; --left) {
      lines_.NextWithin("$Elements");
      const int number = lines_.Int("an element's number");
      const int type = lines_.Int("an element's type");
      const int num_tags = lines_.Int("an element's number of tags", 0, kMaxTag);
      std::vector<int> groups;
      for (int k = 0; k < num_tags; ++k) {
        const int tag = lines_.Int("an element's tag");
        if (k == 0 && tag != 0) groups.push_back(tag);
      }
      ReadElement(number, type, groups);
    }
  }

  void ReadElements41() {
    lines_.NextWithin("$Elements");
    const int num_blocks = Count("the number of element blocks");
    const int num_elements = Count("the number of elements");
    int read = 0;
    for (int block = 0; block < num_blocks; ++block) {
      lines_.NextWithin("$Elements");
      const int dimension = lines_.Int("an entity's dimension", 0, 3);
      const int entity = lines_.Int("an entity's tag");
      const int type = lines_.Int("the elements' type");
      const int count = Count("a block's number of elements");
      const auto groups = groups_of_.find({dimension, entity});
      if (groups == groups_of_.end()) {
        lines_.Fail("$Entities has no entity ", entity, " of dimension ", dimension);
      }
      for (int i = 0; i < count; ++i, ++read) {
        lines_.NextWithin("$Elements");
        const int number = lines_.Int("an element's number");
        ReadElement(number, type, groups->second);
      }
    }
    if (read != num_elements) {
      lines_.Fail("the blocks have ", read, " elements, must have ", num_elements);
    }
  }

  // The line's rest: the nodes. Takes what is of use and passes over the rest.
  void ReadElement(const int number, const int type, const std::vector<int>& groups) {
    if (Contains(kPointsAndCurves, type) || groups.empty()) return;
    const bool tetrahedron = type == kTetrahedron4 || type == kTetrahedron10;
    if (tetrahedron) {
      NoteOrder(number, type == kTetrahedron10 ? 2 : 1);
      tetrahedra_.push_back(ReadElementNodes(number, type == kTetrahedron10 ? 10 : 4));
      return;
    }
    const bool triangle = type == kTriangle3 || type == kTriangle6;
    if (!triangle && !Contains(kOtherSurfaces, type)) {
      lines_.Fail("element ", number, " has type ", type,
                  ", volumes must have tetrahedra of 4 (type 4) or 10 nodes (type 11)");
    }
    std::vector<NodeList*> lists;  // of the groups that the face belongs to
    for (const int tag : groups) {
      const auto name = surface_names_.find(tag < 0 ? -tag : tag);
      if (name == surface_names_.end()) continue;
      if (name->second == "mount") lists.push_back(&mount_);
      if (name->second == "cavity") lists.push_back(&cavity_);
    }
    if (lists.empty()) return;
    if (!triangle) {
      lines_.Fail("element ", number, " of group `", lists[0] == &mount_ ? "mount" : "cavity",
                  "` has type ", type, ", must be a triangle of 3 (type 2) or 6 nodes (type 9)");
    }
    NoteOrder(number, type == kTriangle6 ? 2 : 1);
    const auto face = ReadElementNodes(number, type == kTriangle6 ? 6 : 3);
    for (NodeList* list : lists) list->push_back(face);
  }

  void NoteOrder(const int number, const int order) {
    if (order_ == 0) order_ = order;
    if (order_ != order) {
      lines_.Fail("element ", number, " has order ", order, ", must have that of those before, ",
                  order_);
    }
  }

  std::array<int, 10> ReadElementNodes(const int number, const int count) {
    std::array<int, 10> result{};
    for (int k = 0; k < count; ++k) {
      const int tag = lines_.Int("an element's node");
      const auto node = nodes_.find(tag);
      if (node == nodes_.end()) {
        lines_.Fail("element ", number, " names node ", tag, ", which $Nodes does not have");
      }
      result[static_cast<std::size_t>(k)] = node->second;
    }
    lines_.ExpectEndOfLine();
    return result;
  }

  TetMesh Build() const {
    if (tetrahedra_.empty()) {
      lines_.Fail("no tetrahedra in a physical volume, must have at least one");
    }
    if (mount_.empty()) lines_.Fail("the physical surface `mount` has no triangles");
    if (cavity_.empty()) lines_.Fail("the physical surface `cavity` has no triangles");
    // Keeps the nodes that a tetrahedron uses, in the file's order.
    const int num_nodes = order_ == 2 ? 10 : 4;
    std::vector<int> kept(coordinates_.size(), -1);
    for (const auto& element : tetrahedra_) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(num_nodes); ++k) {
        kept[static_cast<std::size_t>(element[k])] = 0;
      }
    }
    int num_kept = 0;
    Eigen::Matrix3Xd nodes(3, coordinates_.size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (kept[i] < 0) continue;
      nodes.col(num_kept) = coordinates_[i];
      kept[i] = num_kept++;
    }
    nodes.conservativeResize(3, num_kept);

    const auto renumber = [&kept](const NodeList& list, const int rows) {
      MatrixXi result(rows, static_cast<int>(list.size()));
      for (std::size_t i = 0; i < list.size(); ++i) {
        for (int k = 0; k < rows; ++k) {
          const auto gmsh_k = static_cast<std::size_t>(rows == 10 ? kGmshNode[k] : k);
          result(k, static_cast<int>(i)) = kept[static_cast<std::size_t>(list[i][gmsh_k])];
        }
      }
      return result;
    };
    const int face_nodes = order_ == 2 ? 6 : 3;
    return MakeTetMesh(path_, std::move(nodes), renumber(tetrahedra_, num_nodes),
                       renumber(cavity_, face_nodes), renumber(mount_, face_nodes));
  }

  std::string path_;
  TextLines lines_;
  Version version_{kVersion22};
  std::map<int, std::string> surface_names_;   // physical surfaces by tag
  std::map<Tag, std::vector<int>> groups_of_;  // entity -> its physical groups (version 4.1)
  std::unordered_map<int, int> nodes_;         // a node's number in the file -> its index
  std::vector<Eigen::Vector3d> coordinates_;   // [m]
  int order_{0};                               // of the elements; 0: none met yet
  NodeList tetrahedra_, cavity_, mount_;       // node indices in Gmsh's order
};

}  // namespace

TetMesh ReadGmsh(const std::string& path) { return Reader(path).Read(); }

}  // namespace vacuum_gripper_sim
