#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"

namespace sidestep {

struct YamlValue;

/// A strict view of one map of a YAML file. Every getter names the key it wants; whatever is wrong
/// becomes an InputError `FILE:LINE: KEY: WHY`. Call CheckNoUnknownKeys() last: a key that nobody
/// asked for is an error, because a misspelt one would silently take a default.
///
/// Keys are reported by their path, e.g. `moving_obstacles[0].motion.linear.speed_m_s`.
class YamlReader {
 public:
  /// Every number lies between minus this and this, whatever its unit, and one that must be > 0 is
  /// at least 1 / this: no length, time or gain is beyond, and neither squares and norms of what
  /// was read nor products of a few of them overflow or vanish.
  static constexpr double kLargestNumber = 1e12;

  /// Reads a whole file, whose top must be a map.
  /// @throws InputError if it is missing, a directory, over 1 MiB, not UTF-8 (a byte-order mark and
  ///   CRLF are taken), or not YAML.
  static YamlReader FromFile(const std::string& path);
  /// The same from a text; `name` stands for the file in messages.
  static YamlReader FromText(const std::string& bytes, const std::string& name);

  ~YamlReader();
  YamlReader(YamlReader&&) noexcept;
  YamlReader& operator=(YamlReader&&) noexcept;

  bool Has(const std::string& key) const;

  std::string GetString(const std::string& key) const;
  bool GetBool(const std::string& key) const;
  int GetInt(const std::string& key) const;
  double GetDouble(const std::string& key) const;    ///< at most kLargestNumber in size
  double GetPositive(const std::string& key) const;  ///< at least 1 / kLargestNumber
  double GetNonNegative(const std::string& key) const;
  std::vector<double> GetDoubles(const std::string& key) const;  ///< each as GetDouble, any length
  /// A list of lists of numbers, each as GetDouble, of any lengths.
  std::vector<std::vector<double>> GetRows(const std::string& key) const;
  Eigen::VectorXd GetVector(const std::string& key, int length) const;
  Eigen::Vector3d GetVector3(const std::string& key) const;
  Eigen::Vector3d GetPositiveVector3(const std::string& key) const;
  std::vector<std::string> GetStrings(const std::string& key) const;
  /// Checks that the string is one of `choices`; the message lists them.
  std::string GetChoice(const std::string& key, const std::vector<std::string>& choices) const;
  /// A map {position_m: [x, y, z], rpy_rad: [r, p, y]}; rpy_rad may be left out.
  Pose GetPose(const std::string& key) const;

  /// This map with `value`, in YAML, at a path such as `planner.epsilon_m` or
  /// `moving_obstacles[0].shape` (core/yaml_tree.h); where the path leads through maps and lists
  /// that exist, its last key may be new. What is then found wrong with it is reported as `BY PATH:
  /// WHY`, e.g. `--set planner.epsilon_m: must be >= 0, is -1`; so is what is wrong with a list or
  /// map of which it is a part.
  /// @throws InputError if it is no path, leads nowhere, or the value is not YAML.
  YamlReader With(const std::string& path, const std::string& value, const std::string& by) const;

  /// This map with every key of `part`, of the same file, in place of its own.
  YamlReader With(const YamlReader& part) const;

  /// This map without a key.
  YamlReader Without(const std::string& key) const;

  /// True if the value of `key` is a scalar (and not a list or a map).
  bool IsScalar(const std::string& key) const;
  /// True if the value of `key` is a map.
  bool IsMap(const std::string& key) const;
  /// True if the value of `key` is a list whose first item is a map.
  bool IsListOfMaps(const std::string& key) const;

  YamlReader GetMap(const std::string& key) const;
  std::vector<YamlReader> GetMaps(const std::string& key) const;  ///< a list of maps
  std::vector<std::string> Keys() const;                          ///< in the file's order

  /// @throws InputError at the first key that no getter (nor Has) was asked for.
  void CheckNoUnknownKeys() const;

  /// The line of the value of `key` (of the map itself if it is absent), counted from 1.
  int Line(const std::string& key) const;

  /// The lines of everything in this map, by its path; 0 of what was set by With. Items of lists
  /// are there only if they are maps, or were set.
  std::map<std::string, int> Lines() const;

  /// Throws the InputError for `key`, or for an item of its list by "key[3]", at its line (or at
  /// the map's own line if it is absent).
  /// @param against the key of this map that it does not agree with: where only that was set, it is
  ///   blamed, `BY AGAINST: KEY: WHY`.
  [[noreturn]] void Fail(const std::string& key, const std::string& why,
                         const std::string& against = "") const;

 private:
  struct Node;
  explicit YamlReader(std::unique_ptr<Node> node);
  YamlReader WithValue(std::shared_ptr<const YamlValue> value) const;
  std::unique_ptr<Node> node_;
};

}  // namespace sidestep
