#include "sidestep/import/mesh_uri.h"

#include <filesystem>
#include <optional>
#include <string_view>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"

namespace sidestep::imports {
namespace {

namespace fs = std::filesystem;

std::string WithoutEscapes(std::string_view text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 &&
        digit(text[i + 2]) >= 0) {
      plain += static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2]));
      i += 2;
    } else {
      plain += text[i];
    }
  }
  return plain;
}

bool IsFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

std::string NameOf(fs::path folder) {
  if (!folder.has_filename()) folder = folder.parent_path();  // a/b/
  return folder.filename().string();
}

// The folders that may be the package of a name, the best first.
std::vector<fs::path> PackagesOf(const std::string& name, const std::string& urdf_path,
                                 const std::vector<std::string>& package_paths) {
  std::vector<fs::path> packages;
  const auto consider = [&](const fs::path& folder) {
    if (IsFolder(folder / name)) packages.push_back(folder / name);
    if (NameOf(folder) == name) packages.push_back(folder);
  };
  for (const std::string& folder : package_paths) consider(fs::absolute(folder));
  std::error_code error;  // a pipe, as of a shell's <(xacro FILE), has a name but no place
  fs::path folder = fs::weakly_canonical(urdf_path, error).parent_path();
  if (error) folder = fs::absolute(urdf_path).parent_path();
  while (true) {
    consider(folder);
    if (folder == folder.parent_path()) return packages;
    folder = folder.parent_path();
  }
}

std::string InPackage(const std::string& uri, std::string_view rest, const std::string& urdf_path,
                      const std::vector<std::string>& package_paths) {
  const std::size_t slash = rest.find('/');
  if (slash == std::string_view::npos || slash == 0) {
    throw InputError(uri, "must be " + uri.substr(0, uri.find(':')) + "://PACKAGE/FILE");
  }
  const std::string name(rest.substr(0, slash)), file(rest.substr(slash + 1));
  const std::vector<fs::path> packages = PackagesOf(name, urdf_path, package_paths);
  if (packages.empty()) {
    throw InputError(uri, "there is no package '" + name + "' beside the URDF or above it" +
                              (package_paths.empty() ? "" : ", nor in " + Joined(package_paths)) +
                              "; say where it is by --package-path");
  }
  std::error_code error;
  for (const fs::path& package : packages) {
    if (fs::exists(package / file, error)) return (package / file).string();
  }
  throw InputError(uri, "the package at " + packages.front().string() + " holds no such file");
}

}  // namespace

std::string ResolveMeshUri(const std::string& uri, const std::string& urdf_path,
                           const std::vector<std::string>& package_paths) {
  const std::string_view text = uri;
  for (const std::string_view scheme : {"package://", "model://"}) {
    if (text.starts_with(scheme)) {
      return InPackage(uri, text.substr(scheme.size()), urdf_path, package_paths);
    }
  }
  fs::path path = uri;
  if (text.starts_with("file://")) {
    path = WithoutEscapes(text.substr(7));
  } else if (text.find("://") != std::string_view::npos) {
    throw InputError(uri, "only package://, model:// and file:// are taken");
  }
  if (path.is_relative()) path = fs::path(urdf_path).parent_path() / path;
  std::error_code error;
  if (!fs::exists(path, error)) throw InputError(uri, "there is no " + path.string());
  return path.string();
}

}  // namespace sidestep::imports
