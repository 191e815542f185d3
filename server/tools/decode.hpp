#pragma once
// roverd decode KIND FILE|-: what a recording says, one JSON object a line on standard output.
//
//   bunker   candump's text, as on the screen or as a log (-L)    decode_bunker.cpp
//   nmea     the bytes of a GNSS receiver, UBX and RTCM3 between   decode_nmea.cpp
//   ubx      the same bytes, the UBX frames read too               decode_ubx.cpp
//   mti      the bytes of an Xsens MTi                             decode_mti.cpp
//   vlp16    datagrams of a Velodyne VLP-16: a capture, or bare    decode_vlp16.cpp
//   sick     the bytes of a SICK scanner, or a session as text    decode_sick.cpp
//   cloud    frames of docs/cloud-format.md                        decode_cloud.cpp
//   ranges   lines of ultrasonic and infrared rangers              decode_cloud.cpp
//   vision   datagrams of a vision program: a capture, or lines    decode_vision.cpp
//
// Fields are named as in the fact sheets' tables. What is not understood is a line too, with the
// reason under "refused". Files of any size: nothing but the present block is kept. New kinds are a
// row in decode.cpp and a function that makes their Reader.

#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include "base/bytes.hpp"

namespace roverd {

/// Takes a recording in pieces of any size.
struct Reader {
  std::function<void(base::Bytes)> feed;
  std::function<void()> finish;  ///< no more will come
};

using OnObject = std::function<void(const nlohmann::ordered_json&)>;

/// Objects: line (counted from 1), time (seconds as stamped; null without), interface, id, data,
/// then protocol, name and fields of what the frame says.
Reader bunker_reader(OnObject on_object);
/// Objects: sentence, talker and fields; or the text, or the size of a binary frame; or how many
/// bytes were skipped.
Reader nmea_reader(OnObject on_object);
/// As nmea_reader, but a UBX frame is message, class, id and its fields in m, m/s, deg, s.
Reader ubx_reader(OnObject on_object);
/// @param frame intact.
nlohmann::ordered_json ubx_object(base::Bytes frame);
/// Objects: message, mid and fields; MTData2: packets, each with xdi, content and its fields.
Reader mti_reader(OnObject on_object);
/// Takes a capture (pcap) or packets one after another. Objects: packet (counted from 0), message
/// (data, position) and fields; of a capture also time, from, to_port.
Reader vlp16_reader(OnObject on_object);
/// Objects: of a session line, time and direction; then dialect, type and command of the telegram
/// and its fields: of a scan all, angles in deg, frequencies in Hz, values as the scanner has them.
Reader sick_reader(OnObject on_object);

/// Objects: message (cloud, depth, ranges), sequence, stamp_ns, good, pose and the fields of each;
/// of images and clouds how many points they have, not each. Causes of refusal with their count.
Reader cloud_reader(OnObject on_object);
/// Objects: line and range_m: metres (a bare number is taken as such), "nothing" or "unknown".
Reader ranges_reader(OnObject on_object);
/// Takes a capture (pcap) or one datagram a line. Objects: packet (counted from 0), names,
/// landmarks (name, x_m, y_m, z_m), obstacles, planes (centre, normal, size), in the camera's axes;
/// of a capture also time, from, to_port.
Reader vision_reader(OnObject on_object);

/// The text of one line, with its line feed. Bytes that are not UTF-8 are replaced.
std::string to_line(const nlohmann::ordered_json& object);

/// roverd decode KIND FILE. @param kind "bunker", "nmea", "ubx", "mti", "sick", "vlp16", "cloud",
/// "ranges" or "vision"
/// @param file "-": standard input. @return exit code: 0 all was read (or nobody wants to hear
/// more), 1 the file cannot be read or the output not written, 2 there is no such kind.
int decode(const std::string& kind, const std::string& file);

}  // namespace roverd
