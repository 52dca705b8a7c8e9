// SPDX-License-Identifier: Apache-2.0
#pragma once

// Small routing instances, one in each format.
namespace headland::testing {

inline constexpr const char* kAtsp =
    "NAME: four\nTYPE: ATSP\nDIMENSION: 4\nEDGE_WEIGHT_TYPE: EXPLICIT\n"
    "EDGE_WEIGHT_FORMAT: FULL_MATRIX\nEDGE_WEIGHT_SECTION\n"
    "9999 1 9 9\n9 9999 2 9\n9 9 9999 3 4\n9 9 9999\nEOF\n";

inline constexpr const char* kEvrp =
    "Name: two customers and a station \r\nTYPE: EVRP \r\nDIMENSION: 3 \r\nSTATIONS: 1\r\n"
    "CAPACITY: 10 \r\nENERGY_CAPACITY: 12 \r\nENERGY_CONSUMPTION: 1.20 \r\n"
    "EDGE_WEIGHT_FORMAT: EUC_2D\r\nNODE_COORD_SECTION \r\n1 0 0 \r\n2 3 4 \r\n3 0 -3 \r\n"
    "4 3 0 \r\nDEMAND_SECTION \r\n1 0 \r\n2 6 \r\n3 7 \r\nSTATIONS_COORD_SECTION\r\n4 \r\n"
    "DEPOT_SECTION\r\n1\r\n-1\r\nEOF";

inline constexpr const char* kEvrptw =
    "StringID   Type  x  y  demand  ReadyTime  DueDate  ServiceTime\n"
    "D0 d 0 0 0 0 100 0\nS0 f 0 0 0 0 100 0\nS1 f 6 0 0 0 100 0\n"
    "C1 c 3 4 10 20 30 5\nC2 c 0 8 4 0 90 5\n\n"
    "Q Vehicle fuel tank capacity /13/\nC Vehicle load capacity /20/\n"
    "r fuel consumption rate /1.0/\ng inverse refueling rate /2.0/\nv average Velocity /0.5/\n";

inline constexpr const char* kChao = "12\t1\n0 0 0\n6 0 0\n3 4 10\n3 0 4\n3 -40 50\n";

inline constexpr const char* kOplib =
    "NAME : three\nTYPE : OP\nDIMENSION : 3\nCOST_LIMIT : 11\nEDGE_WEIGHT_TYPE : EUC_2D\n"
    "NODE_COORD_SECTION\n1 0 0\n2 3 4\n3 50 0\nNODE_SCORE_SECTION\n1 0\n2 5\n3 7\n"
    "DEPOT_SECTION\n1\n-1\nEOF\n";

}  // namespace headland::testing
