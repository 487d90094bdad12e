#include "sidestep/bench/peers/worker.h"

#include <fstream>
#include <iostream>

namespace sidestep::bench {

int ServeTransform(const TimedTransform& transform) {
  OccupancyGrid grid;
  std::vector<float> distance;
  for (std::string command, argument; std::cin >> command >> argument;) {
    if (command == "grid") {
      int n = 0;
      std::cin >> n;
      grid = OccupancyGrid({Eigen::Vector3d::Zero(), 1, {n, n, n}});
      std::ifstream(argument, std::ios::binary)
          .read(reinterpret_cast<char*>(grid.cells.data()),
                static_cast<std::streamsize>(grid.cells.size()));
      distance.assign(grid.cells.size(), 0);
      std::cout << "ok" << std::endl;
    } else if (command == "run") {
      std::cout << 1e3 * transform(grid, argument, distance) << std::endl;
    } else if (command == "save") {
      std::ofstream(argument, std::ios::binary)
          .write(reinterpret_cast<const char*>(distance.data()),
                 static_cast<std::streamsize>(distance.size() * sizeof(float)));
      std::cout << "ok" << std::endl;
    } else {
      std::cerr << "unknown command '" << command << "'\n";
      return 2;
    }
  }
  return 0;
}

}  // namespace sidestep::bench
