#include "sidestep/import/mesh_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/core/markup.h"
#include "sidestep/core/text_file.h"
#include "sidestep/import/isolated.h"

namespace sidestep::imports {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxMeshBytes = 256u << 20;

std::string EndingOf(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

void CheckFile(const std::string& path, const std::string& ending) {
  std::error_code error;
  if (!fs::exists(path, error)) throw InputError(path, "is not there");
  if (!fs::is_regular_file(path, error)) throw InputError(path, "is no file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw InputError(path, error.message());
  if (size > kMaxMeshBytes) {
    throw InputError(path, "is " + std::to_string(size) + " bytes long, must be at most " +
                               std::to_string(kMaxMeshBytes));
  }
  if (ending != ".stl" && ending != ".obj" && ending != ".dae") {
    throw InputError(path, "must be an STL, OBJ or DAE file");
  }
}

Eigen::Affine3d AffineOf(const aiMatrix4x4& m) {
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  X.matrix().topRows<3>() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4;
  return X;
}

struct Soup {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

void Collect(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& X_FParent,
             Soup* soup) {
  const Eigen::Affine3d X_FN = X_FParent * AffineOf(node.mTransformation);
  const bool is_mirrored = X_FN.linear().determinant() < 0;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    const int first = static_cast<int>(soup->vertices.size());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      soup->vertices.push_back(X_FN * Eigen::Vector3d(p.x, p.y, p.z));
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      Eigen::Vector3i corners(static_cast<int>(face.mIndices[0]),
                              static_cast<int>(face.mIndices[1]),
                              static_cast<int>(face.mIndices[2]));
      if (is_mirrored) std::swap(corners(1), corners(2));
      soup->triangles.push_back(corners.array() + first);
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    Collect(scene, *node.mChildren[i], X_FN, soup);
  }
}

// Vertices at one place are one vertex; a place is a millionth of the mesh wide, for files round.
TriangleMesh JoinedSoup(const Soup& soup) {
  using Place = Eigen::Matrix<std::int64_t, 3, 1>;
  struct Hash {
    std::size_t operator()(const Place& place) const {
      std::size_t hash = 0;
      for (const std::int64_t i : place) hash = hash * 1000003 + std::hash<std::int64_t>()(i);
      return hash;
    }
  };
  Eigen::Vector3d low = soup.vertices.front(), high = low;
  for (const Eigen::Vector3d& p : soup.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double width = std::max(1e-6 * (high - low).maxCoeff(), 1e-300);
  std::unordered_map<Place, int, Hash> places;
  places.reserve(soup.vertices.size());
  std::vector<int> index;
  std::vector<Eigen::Vector3d> distinct;
  for (const Eigen::Vector3d& p : soup.vertices) {
    const Place at = ((p - low) / width).array().round().matrix().cast<std::int64_t>();
    const auto [place, is_new] = places.emplace(at, static_cast<int>(distinct.size()));
    if (is_new) distinct.push_back(p);
    index.push_back(place->second);
  }
  TriangleMesh mesh;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(distinct.size()));
  for (std::size_t i = 0; i < distinct.size(); ++i) {
    mesh.vertices.col(static_cast<Eigen::Index>(i)) = distinct[i];
  }
  mesh.triangles.resize(3, static_cast<Eigen::Index>(soup.triangles.size()));
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      mesh.triangles(k, static_cast<Eigen::Index>(i)) =
          index[static_cast<std::size_t>(soup.triangles[i](k))];
    }
  }
  return mesh;
}

// Edges whose two sides are not one triangle each.
std::size_t CountOpenEdges(const TriangleMesh& mesh) {
  std::unordered_map<std::uint64_t, int> sides;  // there minus back
  sides.reserve(static_cast<std::size_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles.colwise()) {
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<std::uint64_t>(t(k));
      const auto b = static_cast<std::uint64_t>(t((k + 1) % 3));
      if (a == b) continue;
      sides[std::min(a, b) << 32 | std::max(a, b)] += a < b ? 1 : -1;
    }
  }
  return static_cast<std::size_t>(
      std::count_if(sides.begin(), sides.end(), [](const auto& side) { return side.second != 0; }));
}

// As the file says, "Z_UP" most often.
std::string UpAxisOf(const std::string& path) {
  const std::string text = ReadTextFile(path, kMaxMeshBytes);
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw XmlFault(path, document.ErrorLineNum(), document.ErrorName());
  }
  for (const tinyxml2::XMLNode* node = document.FirstChild(); node != nullptr;
       node = node->NextSibling()) {
    if (node->ToUnknown() != nullptr) {
      throw InputError(path, node->GetLineNum(), "<!", "is not taken in a mesh");
    }
  }
  const tinyxml2::XMLElement* element = document.RootElement();
  if (element != nullptr) element = element->FirstChildElement("asset");
  if (element != nullptr) element = element->FirstChildElement("up_axis");
  const char* const axis = element == nullptr ? nullptr : element->GetText();
  return axis == nullptr ? "Y_UP" : axis;  // COLLADA's own default
}

Eigen::Matrix3d TurnToZUp(const std::string& up_axis) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (up_axis.find("Y_UP") != std::string::npos) R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up_axis.find("X_UP") != std::string::npos) R << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return R;
}

// With assimp, which is not to be trusted with damaged files.
LoadedMesh Import(const std::string& path, const std::string& ending, const MeshReading& reading) {
  LoadedMesh loaded;
  Eigen::Affine3d X_RF = Eigen::Affine3d::Identity();
  if (ending == ".dae") {
    const std::string up = UpAxisOf(path);
    const Eigen::Matrix3d R = TurnToZUp(up);
    if (!R.isIdentity()) {
      loaded.notes.push_back(
          "has its up axis along " + up.substr(0, 1) +
          (reading.turn_up_axis ? ": turned so that it is z" : ": taken as it is"));
      if (reading.turn_up_axis) X_RF.linear() = R;
    }
  }
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyInteger(
      AI_CONFIG_PP_RVC_FLAGS,
      aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
          aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
          aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS | aiComponent_MATERIALS);
  const aiScene* const scene =
      importer.ReadFile(path, aiProcess_Triangulate | aiProcess_RemoveComponent);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw InputError(path, std::string("is no mesh: ") + importer.GetErrorString());
  }
  Soup soup;
  Collect(*scene, *scene->mRootNode, X_RF, &soup);
  if (soup.triangles.empty()) throw InputError(path, "holds no triangle");
  for (const Eigen::Vector3d& vertex : soup.vertices) {
    if (!vertex.allFinite()) throw InputError(path, "has a vertex that is not finite");
  }
  loaded.mesh = JoinedSoup(soup);
  const std::size_t open = CountOpenEdges(loaded.mesh);
  if (open > 0) {
    loaded.notes.push_back("is not closed: " + std::to_string(open) +
                           " of its edges lack a triangle on one side");
  } else if (SignedVolume_m3(loaded.mesh) < 0) {
    loaded.notes.push_back("is inside out");
  }
  return loaded;
}

// A mesh as bytes, from one process to another of this program.
template <class Number>
void Append(const Number* numbers, std::size_t count, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&count), sizeof count);
  bytes->append(reinterpret_cast<const char*>(numbers), count * sizeof(Number));
}

std::string ToBytes(const LoadedMesh& loaded) {
  std::string bytes;
  Append(loaded.mesh.vertices.data(), static_cast<std::size_t>(loaded.mesh.vertices.size()),
         &bytes);
  Append(loaded.mesh.triangles.data(), static_cast<std::size_t>(loaded.mesh.triangles.size()),
         &bytes);
  for (const std::string& note : loaded.notes) Append(note.data(), note.size(), &bytes);
  return bytes;
}

class Bytes {
 public:
  explicit Bytes(const std::string& bytes) : bytes_(bytes) {}
  bool AreLeft() const { return at_ < bytes_.size(); }

  template <class Number>
  std::vector<Number> Take() {
    std::size_t count = 0;
    std::memcpy(&count, bytes_.data() + at_, sizeof count);
    std::vector<Number> numbers(count);
    if (count > 0) {
      std::memcpy(numbers.data(), bytes_.data() + at_ + sizeof count, count * sizeof(Number));
    }
    at_ += sizeof count + count * sizeof(Number);
    return numbers;
  }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

LoadedMesh FromBytes(const std::string& text) {
  Bytes bytes(text);
  LoadedMesh loaded;
  const std::vector<double> vertices = bytes.Take<double>();
  const std::vector<int> triangles = bytes.Take<int>();
  loaded.mesh.vertices = Eigen::Map<const Eigen::Matrix3Xd>(
      vertices.data(), 3, static_cast<Eigen::Index>(vertices.size() / 3));
  loaded.mesh.triangles = Eigen::Map<const Eigen::Matrix3Xi>(
      triangles.data(), 3, static_cast<Eigen::Index>(triangles.size() / 3));
  while (bytes.AreLeft()) {
    const std::vector<char> note = bytes.Take<char>();
    loaded.notes.emplace_back(note.begin(), note.end());
  }
  return loaded;
}

}  // namespace

LoadedMesh LoadMesh(const std::string& path, const MeshReading& reading) {
  const std::string ending = EndingOf(path);
  CheckFile(path, ending);
  try {
    return FromBytes(RunIsolated([&] { return ToBytes(Import(path, ending, reading)); }));
  } catch (const std::runtime_error& error) {
    throw AsInputError(path, error);
  }
}

}  // namespace sidestep::imports
