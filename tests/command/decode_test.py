#!/usr/bin/env python3
"""roverd decode: the fact sheets' vectors, everything that is refused, and recordings of others.

Recordings are taken from ROVERD_REAL_DATA where that is set; a missing one is a skipped test.
"""

import bz2
import gzip
import json
import lzma
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, check, run_cases  # noqa: E402

ROVERD = BIN / "roverd"
FOLDER = pathlib.Path(os.environ.get("ROVERD_REAL_DATA", ""))


def run(*arguments, data=b""):
    return subprocess.run([ROVERD, "decode", *map(str, arguments)], input=data, capture_output=True,
                          timeout=60, check=False)


def decoded(kind, data):
    """The objects of these bytes, from standard input."""
    done = run(kind, "-", data=data)
    check(done.returncode == 0, f"exit code {done.returncode}: {done.stderr}")
    check(not done.stderr, f"says {done.stderr}")
    return [json.loads(line) for line in done.stdout.splitlines()]


def same(got, wanted, where):
    for name, value in wanted.items():
        check(name in got, f"{where}: no {name} in {got}")
        near = (isinstance(value, float) and isinstance(got[name], (int, float))
                and abs(got[name] - value) < 1e-9)
        check(near or got[name] == value, f"{where}: {name} is {got[name]!r}, not {value!r}")


def nothing_to_decode():
    """a capture without packets, and one that is packed, say so"""
    header = bytes.fromhex("d4c3b2a1020004000000000000000000ffff000001000000")
    for data in (b"", header):
        done = run("vlp16", "-", data=data)
        check(done.returncode == 1, f"exit code {done.returncode}")
        check(done.stderr == b"roverd: standard input: there are no packets in it\n", done.stderr)
    for packer, magic in (("gzip", gzip.compress(header)), ("xz", lzma.compress(header)),
                          ("bzip2", bz2.compress(header))):
        done = run("vlp16", "-", data=magic)
        check(done.returncode == 1, f"exit code {done.returncode}")
        check(f"is packed: {packer} -dc FILE | roverd decode vlp16 -".encode() in done.stderr, done.stderr)


# id, data, fields of the fact sheet
BUNKER = [
    ("111", "00 96 00 00 00 00 00 00", {"linear_mps": 0.15, "angular_radps": 0.0, "lateral_mps": 0.0, "steering_rad": 0.0}),
    ("111", "00 00 00 C8 00 00 00 00", {"linear_mps": 0.0, "angular_radps": 0.2}),
    ("111", "FF 06 FE 70 00 00 00 00", {"linear_mps": -0.25, "angular_radps": -0.4}),
    ("211", "01 00 01 00 00 80 00 00", {
        "vehicle_state": "estop", "vehicle_state_raw": 1, "control_mode": "standby",
        "control_mode_raw": 0, "battery_v": 25.6, "error_code": 128, "errors": ["bit7_reserved"], "count": 0}),
    ("211", "00 01 01 E7 00 06 00 11", {
        "vehicle_state": "normal", "control_mode": "can", "battery_v": 48.7, "error_code": 6,
        "errors": ["battery_warning", "rc_signal_loss"], "count": 17}),
    ("221", "02 DB FF CC 00 00 00 00", {"linear_mps": 0.731, "angular_radps": -0.052}),
    ("231", "01 03 3C 00 00 00 00 09", {
        "enabled": True, "front_mode": 3, "front_value": 60, "rear_mode": 0, "rear_value": 0, "count": 9}),
    ("241", "AA 00 00 00 00 00 00 61", {"swa": "up", "swb": "up", "swc": "up", "swd": "up", "count": 97}),
    ("241", "97 19 C4 00 00 64 00 C8", {
        "swa": "down", "swb": "middle", "swc": "middle", "swd": "up", "right_lr": 25,
        "right_ud": -60, "byte3": 0, "byte4": 0, "vra": 100, "count": 200}),
    ("241", "E1 00 00 00 00 00 00 C9", {"swa": "unknown", "swb": "unknown", "swc": "up", "swd": "down"}),
    ("251", "04 D2 00 39 FF FE 79 60", {"motor": 1, "rpm": 1234, "current_a": 5.7, "pulses": -100000}),
    ("252", "FB 2E FF E1 7F FF FF FF", {"motor": 2, "rpm": -1234, "current_a": -3.1, "pulses": 2147483647}),
    ("253", "F8 30 00 7B 80 00 00 00", {"motor": 3, "rpm": -2000, "current_a": 12.3, "pulses": -2147483648}),
    ("254", "00 01 FF FF 00 00 00 01", {"motor": 4, "rpm": 1, "current_a": -0.1, "pulses": 1}),
    ("263", "01 EB 00 26 29 40 00 00", {"motor": 3, "driver_voltage_v": 49.1, "driver_flags": ["driver_enabled"]}),
    ("264", "02 58 FF D8 80 10 00 00", {
        "motor": 4, "driver_voltage_v": 60.0, "driver_temp_c": -40, "motor_temp_c": -128,
        "driver_flags": ["sensor_fault"]}),
    ("261", "01 EB 00 26 29 40 00 00", {
        "motor": 1, "driver_voltage_v": 49.1, "driver_temp_c": 38, "motor_temp_c": 41,
        "driver_state": 64, "driver_flags": ["driver_enabled"]}),
    ("262", "00 CD FF F9 FD 23 00 00", {
        "motor": 2, "driver_voltage_v": 20.5, "driver_temp_c": -7, "motor_temp_c": -3, "driver_state": 35,
        "driver_flags": ["supply_voltage_low", "motor_overheat", "driver_fault"]}),
    ("311", "00 00 30 39 FF FF CF C7", {"left_mm": 12345, "right_mm": -12345}),
    ("311", "80 00 00 00 7F FF FF FF", {"left_mm": -2147483648, "right_mm": 2147483647}),
    ("361", "50 63 02 1C FF 85 01 3B", {
        "soc_pct": 80, "soh_pct": 99, "voltage_v": 54.0, "current_a": -12.3, "temperature_c": 31.5}),
    ("362", "10 20 00 01 00 00 00 00", {"alarm1": 16, "alarm2": 32, "warn1": 0, "warn2": 1}),
    ("421", "01 00 00 00 00 00 00 00", {"control_mode": "can"}),
    ("441", "00 00 00 00 00 00 00 00", {"motor": 0}),
    ("130", "01 00 E7 19 00 00 42 7C", {
        "protocol": "V1", "control_mode": "can", "linear_pct": -25, "angular_pct": 25, "count": 0x42}),
    ("131", "01 2C FF 9C 00 00 07 09", {"protocol": "V1", "linear_mps": 0.3, "angular_radps": -0.1, "count": 7}),
    ("151", "00 01 00 F5 00 00 03 53", {
        "protocol": "V1", "vehicle_state": "normal", "control_mode": "can", "battery_v": 24.5,
        "errors": [], "count": 3}),
    ("200", "FF F1 03 E8 23 28 01 31", {
        "protocol": "V1", "motor": 1, "current_a": -1.5, "rpm": 1000, "driver_temp_c": 35, "motor_temp_c": 40}),
]


def bunker_vectors():
    """every vector of the Bunker's fact sheet, from the screen form and from the log form"""
    screen = "".join(f"  can0  {i}   [8]  {d}\n" for i, d, _ in BUNKER)
    stamped = "".join(f" (1700000000.250000)  can0  {i}   [8]  {d}\n" for i, d, _ in BUNKER)
    log = "".join(f"(1700000000.250000) can0 {i}#{d.replace(' ', '')}\n" for i, d, _ in BUNKER)
    for form, time in ((screen, None), (stamped, 1700000000.25), (log, 1700000000.25)):
        objects = decoded("bunker", form.encode())
        check(len(objects) == len(BUNKER), f"{len(objects)} objects of {len(BUNKER)} lines")
        for got, (frame_id, data, wanted) in zip(objects, BUNKER):
            same(got, wanted | {"time": time, "interface": "can0", "id": "0x" + frame_id, "data": data},
                 f"{frame_id} {data}")
            check("refused" not in got, f"refused: {got}")


def bunker_refusals():
    """what is no frame, or none to believe, carries its reason"""
    lines = [
        ("can0 221#00010203040506", "0x221 too short"),
        ("can0 123#00", "unknown id 0x123"),
        ("can0 255#0000000000000000", "unknown id 0x255"),
        ("can0 254#00000000000000", "0x254 too short"),
        ("can0 00000221#0001020304050607", "extended id"),
        ("can0 221#R8", "remote frame"),
        ("can0 20000040#0000000000000000", "error frame"),
        ("can0 211#0001FFFF00000000", "impossible value: battery 6553.5 V"),
        ("can0 221#7D00000000000000", "impossible value: speed 32 m/s"),
        ("can0 421#03", "0x421 with an unlisted code"),
        ("can0 151#000100F500000300", "0x151 with a wrong checksum"),
        ("can0 221##0112233", "CAN FD frames are not supported"),
        ("hello", "the frame is missing"),
        ("x" * 10000, "the line is too long for a frame"),
    ]
    objects = decoded("bunker", "\n".join(line for line, _ in lines).encode())
    check(len(objects) == len(lines), f"{len(objects)} objects")
    for number, (got, (line, reason)) in enumerate(zip(objects, lines), 1):
        same(got, {"line": number, "refused": reason}, line[:40])


def v1_has_another_0x211():
    """on a bus of protocol V1, 0x211 is the answer to a setting"""
    objects = decoded("bunker", b"can0 151#000100F500000353\ncan0 211#AA00000000000000\n")
    check("answer to a setting" in objects[1]["refused"], objects[1])


NMEA = [
    ("$GNGGA,101530.20,3352.1234567,S,15112.7654321,W,4,17,0.6,58.312,M,21.705,M,1.2,0042*6A", {
        "sentence": "GGA", "talker": "GN", "time_s": 36930.2, "quality": 4, "sats": 17, "hdop": 0.6,
        "alt_msl_m": 58.312, "geoid_sep_m": 21.705, "dgps_age_s": 1.2, "station": 42, "fix": "rtk_fixed"}),
    ("$GNGGA,081500.00,,,,,0,00,99.99,,,,,,*74", {"lat": None, "lon": None, "quality": 0, "sats": 0, "fix": "none"}),
    ("$GNRMC,101530.20,A,3352.1234567,S,15112.7654321,W,1.944,270.50,290224,,,R,V*14", {
        "sentence": "RMC", "valid": True, "speed_kn": 1.944, "speed_mps": 1.00008, "course_deg": 270.5,
        "date": "2024-02-29", "magvar_deg": None, "mode": "R", "nav_status": "V"}),
    ("$GPVTG,54.7,47.1,5.5,10.2*65", {"course_true_deg": 54.7, "speed_kn": 5.5, "speed_kmh": 10.2, "mode": None}),
    ("$GNGSA,A,3,65,72,80,,,,,,,,,,1.5,0.8,1.3,2*32", {
        "auto": True, "fix": 3, "ids": [65, 72, 80], "pdop": 1.5, "hdop": 0.8, "vdop": 1.3, "system": 2}),
    ("$GPGSV,2,1,05,02,10,123,31,05,63,045,47,12,30,290,40,25,08,200,,1*63", {
        "total": 2, "index": 1, "in_view": 5, "signal": 1, "sats": [
            {"id": 2, "el": 10, "az": 123, "snr": 31}, {"id": 5, "el": 63, "az": 45, "snr": 47},
            {"id": 12, "el": 30, "az": 290, "snr": 40}, {"id": 25, "el": 8, "az": 200, "snr": None}]}),
    ("$GNGST,101530.20,1.9,0.014,0.009,38.5,0.012,0.010,0.021*76", {
        "rms_m": 1.9, "major_m": 0.014, "orient_deg": 38.5, "lat_sd_m": 0.012, "alt_sd_m": 0.021}),
    ("$GPHDT,359.97,T*04", {"sentence": "HDT", "talker": "GP", "heading_deg": 359.97}),
    ("$GNTHS,,V*10", {"heading_deg": None, "mode": "V", "valid": False}),
    ("$GNZDA,235959.95,31,12,2026,00,00*72", {"time_s": 86399.95, "date": "2026-12-31", "zone_h": 0, "zone_min": 0}),
    ("$GNGNS,101530.20,3352.1234567,S,15112.7654321,W,RRFN,17,0.6,58.312,21.705,1.2,0042,V*37", {
        "modes": "RRFN", "sats": 17, "station": 42, "nav_status": "V"}),
    ("$GPHDT,10.0,T*00", {"refused": "wrong checksum", "text": "GPHDT,10.0,T*00"}),
    ("$GPHDT,10.0,T", {"refused": "no checksum"}),
    ("$GPGGA,000000.00,6060.00000,N,02456.11000,E,1,08,1.0,25.4,M,17.9,M,,*5C", {"refused": "bad field", "field": 2}),
]


def nmea_vectors():
    """vectors of the GNSS fact sheet, good and damaged"""
    objects = decoded("nmea", "".join(s + "\r\n" for s, _ in NMEA).encode())
    check(len(objects) == len(NMEA), f"{len(objects)} objects of {len(NMEA)} sentences")
    for got, (sentence, wanted) in zip(objects, NMEA):
        same(got, wanted, sentence)
    check(abs(objects[0]["lat"] + 33.868724278333) < 1e-11, objects[0]["lat"])


def nmea_between_other_bytes():
    """binary frames and rubbish between sentences are told, and a last line without its end counts"""
    ubx = bytes.fromhex("b5620501020006010f38")
    objects = decoded("nmea", b"rubbish" + ubx + b"$GPHDT,359.97,T*04\r\n\xff\xfe$GPHDT,359.97,T*04")
    same(objects[0], {"skipped_bytes": 7}, "rubbish")
    same(objects[1], {"ubx": "05 01", "bytes": 10}, "UBX")
    same(objects[2], {"heading_deg": 359.97}, "HDT")
    same(objects[3], {"skipped_bytes": 2}, "two bytes")
    same(objects[4], {"heading_deg": 359.97}, "the last line")
    check(len(objects) == 5, objects)


# frame, fields of the fact sheet
UBX = [
    ("b56201075c0000420612ea0705140b3b2a371900000084ffffff0383ea1dffb5e0a5f50ad0eb91380100c8e300"
     "000e00000014000000e803000006ffffff0c0000000704000017e60f022800000040e201006200040000000000"
     "0000000000000000e4d5",
     {"message": "UBX-NAV-PVT", "iTOW": 302400000, "year": 2026, "sec": 42, "nano": -124, "fixType": 3,
      "gnssFixOK": True, "diffSoln": True, "carrSoln": 2, "numSV": 29, "lon": -151.2000001, "lat": -33.8687243,
      "height": 80.017, "hMSL": 58.312, "hAcc": 0.014, "vAcc": 0.020, "velN": 1.0, "velE": -0.25, "velD": 0.012,
      "gSpeed": 1.031, "headMot": 345.96375, "sAcc": 0.040, "headAcc": 1.23456, "pDOP": 0.98}),
    ("b56201075c00e8030000ea07010100000000140000000000000000000000000000000000000000000000000000"
     "00ffffffffffffffff0000000000000000000000000000000000000000204e000080a812010f27000000000000"
     "00000000000000002d72",
     {"gnssFixOK": False, "usable": False, "lat": None, "lon": None, "hAcc": None, "pDOP": 99.99}),
    ("b562011424000000000000420612ffb5e0a5f50ad0eb91380100c8e30000dd0704fa8a000000c70000002e87",
     {"lon": -151.200000135, "lat": -33.868724293, "height": 80.0174, "hMSL": 58.3114, "hAcc": 0.0138, "vAcc": 0.0199}),
    ("b562013c400001000000004206120c0000009dffffffffffffff640000005acea6010000000022eb05fe150000"
     "00160000002b0000001e000000306f010000000000370100000982",
     {"relPosN": 0.1234, "relPosE": -0.9921, "relPosD": -0.0095, "relPosLength": 0.9998,
      "relPosHeading": 277.09018, "accHeading": 0.94, "isMoving": True, "relPosHeadingValid": True, "carrSoln": 2}),
    ("b562013640000042061200010000000000000000000017b7d1390000000017b7d1b8faed6b3a6f12833917b7d1"
     "3a000000000000000000000000000000000000000000000000a381",
     {"posCovValid": True, "velCovValid": False, "velCov": None}),
    ("b5620a04a00045585420434f524520312e30302028613162326333290000000000000000303031393030303000"
     "00524f4d20424153452030783131384232303630000000000000000000000046575645523d48504720312e3332"
     "0000000000000000000000000000000050524f545645523d32372e333100000000000000000000000000000000"
     "004d4f443d5a45442d463950000000000000000000000000000000000000000337",
     {"swVersion": "EXT CORE 1.00 (a1b2c3)", "hwVersion": "00190000", "module": "ZED-F9P", "protocol": "27.31"}),
    ("b56205010200068a98c1",
     {"message": "UBX-ACK-ACK", "accepted": True, "to": "CFG-VALSET"}),
    ("b56205000200068a97bc",
     {"message": "UBX-ACK-NAK", "accepted": False}),
    ("b56205010200068a98c0",
     {"refused": "what begins like a binary frame has a wrong checksum or length"}),
]

# message, its fields, those of its packets
MTI = [
    ("faff3100d0",
     {"message": "GoToConfigAck", "mid": "31"}, []),
    ("faff01040770012361",
     {"device_id": "07700123"}, []),
    ("faff4201219d",
     {"code": 33, "error": "parameter invalid"}, []),
    ("faff362610200202011060040012d6872010103f000000bf0000003f000000bf000000e0200401800007c5",
     {}, [{"value": 513}, {"value": 1234567}, {"q0": 0.5, "q1": -0.5, "q2": 0.5, "q3": -0.5, "axes": "ENU"},
      {"value": 0x01800007, "gnss_fix": True, "filter_mode": 3}]),
    ("faff360f20350cffe80000002400000b3c000009",
     {}, [{"roll": -1.5, "pitch": 2.25, "yaw": 179.75, "axes": "NED", "format": "fp12.20"}]),
    ("faff362d50420c80000000ffde400000000097502206100000000050d01612800000000001c0000000ffff2000"
     "000000009d",
     {}, [{"lat": -33.5, "lon": 151.25}, {"value": 80.0625}, {"north": 1.5, "east": -0.25, "down": 0.125}]),
    ("faff36364023183fb999999999999abfc999999999999a40239eb851eb851f8023183f50624dd2f1a9fc3f6062"
     "4dd2f1a9fcbf689374bc6a7efaf0",
     {}, [{"x": 0.1, "y": -0.2, "z": 9.81}, {"x": 0.001, "y": 0.002, "z": -0.003}]),
    ("faff361e10100c0ee6b28007ea05140b3b2a37c0200c3e800000bf0000003f400000c2",
     {}, [{"year": 2026, "second": 42, "ns": 250000000, "flags": 0x37}, {"x": 0.25, "y": -0.5, "z": 0.75}]),
    ("faff366170105e1206420007ea05140b3b2a0700000019fffffc18030112005a26eb20ec084e40000138bf0000"
     "e3c8000004b00000076c000005dcffffff060000007d000005f10216e0d6000000fa0016e36000000000009600"
     "820046006e00500037003c92",
     {}, [{"iTOW": 302400000, "fix_type": 3, "satellites": 18, "lon": 151.25, "lat": -33.5, "height": 80.063,
      "hAcc": 1.2, "velN": 1.5, "course": 350.53782, "gDOP": 1.5, "eDOP": 0.6}]),
    ("faff36ff000750200441480000c8",
     {}, [{"content": "altitude", "value": 12.5}]),
    ("faff360f2030103f8000004000000040400000dd",
     {"refused": "a packet runs past the end of the message"}, []),
]


def ubx_vectors():
    """every UBX vector of the GNSS fact sheet"""
    objects = decoded("ubx", bytes.fromhex("".join(frame for frame, _ in UBX)))
    check(len(objects) == len(UBX), f"{len(objects)} objects of {len(UBX)} frames")
    for got, (frame, wanted) in zip(objects, UBX):
        same(got, wanted, frame[:16])


def sentences_and_frames_of_one_port():
    """decode ubx shows the sentences of the same port too"""
    frame = bytes.fromhex(UBX[6][0])
    objects = decoded("ubx", b"$GPHDT,359.97,T*04\r\n" + frame + b"$GPHDT,10.0,T*00\r\n" + frame)
    check([o.get("sentence") or o.get("message") for o in objects]
          == ["HDT", "UBX-ACK-ACK", None, "UBX-ACK-ACK"], objects)
    same(objects[2], {"refused": "wrong checksum"}, "the second sentence")


def mti_vectors():
    """every message of the MTi's fact sheet, in all number formats"""
    objects = decoded("mti", bytes.fromhex("".join(message for message, _, _ in MTI)))
    check(len(objects) == len(MTI), f"{len(objects)} objects of {len(MTI)} messages")
    for got, (message, wanted, packets) in zip(objects, MTI):
        same(got, wanted, message[:16])
        check(len(got.get("packets", [])) == len(packets), got)
        for one, fields in zip(got.get("packets", []), packets):
            same(one, fields, message[:16])


def mti_damage():
    """a wrong checksum is told as skipped bytes, and what follows is read"""
    objects = decoded("mti", bytes.fromhex("faff360f20300c3f8000004000000040400000e2" + MTI[0][0]))
    check(len(objects) == 2 and "wrong checksum" in objects[0]["refused"], objects)
    same(objects[1], MTI[0][1], "the message behind it")


def usage_is_answered():
    """wrong arguments end with 2 and a reason, an unreadable file with 1"""
    for arguments, code, part in (((), 2, "KIND"), (("bunker",), 2, "FILE"), (("bunker", "a", "b"), 2, "FILE"),
                                  (("tape", "-"), 2, "tape"),
                                  (("bunker", "/nowhere/bus.log"), 1, "/nowhere/bus.log"),
                                  (("bunker", "/"), 1, "/")):
        done = run(*arguments)
        lines = done.stderr.decode().splitlines()
        check(done.returncode == code and len(lines) == 1 and part in lines[0] and not done.stdout,
              f"decode {arguments}: {done.returncode} {lines}")
    done = run("--help")
    check(done.returncode == 0 and b"bunker" in done.stdout and b"nmea" in done.stdout, done)


def a_closed_pipe_is_quiet():
    """a reader that has seen enough ends it without a word"""
    with tempfile.NamedTemporaryFile(suffix=".log") as log:
        log.write(b"can0 221#0001020304050607\n" * 50_000)
        log.flush()
        with subprocess.Popen([ROVERD, "decode", "bunker", log.name], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE) as program:
            program.stdout.readline()
            program.stdout.close()
            said = program.stderr.read()
            code = program.wait(20)
    check(code == 0 and not said, f"exit code {code}, says {said}")


def a_long_file_is_streamed():
    """a log of 30 MB is read with less than 64 MB of address space for data"""
    def limit():
        resource.setrlimit(resource.RLIMIT_DATA, (64 << 20, 64 << 20))
    with tempfile.NamedTemporaryFile(suffix=".log") as log:
        for _ in range(12):
            log.write(b"(1700000000.250000) can0 221#02DBFFCC00000000\n" * 55_000)
        log.flush()
        with open(os.devnull, "wb") as nothing:
            done = subprocess.run([ROVERD, "decode", "bunker", log.name], stdout=nothing,
                                  stderr=subprocess.PIPE, preexec_fn=limit, timeout=120, check=False)
    check(done.returncode == 0, f"exit code {done.returncode}: {done.stderr}")


def live_input_is_answered_at_once():
    """a frame on standard input is shown before the next one comes"""
    with subprocess.Popen([ROVERD, "decode", "bunker", "-"], stdin=subprocess.PIPE,
                          stdout=subprocess.PIPE) as program:
        for _ in range(2):
            program.stdin.write(b"can0 221#02DBFFCC00000000\n")
            program.stdin.flush()
            check(json.loads(program.stdout.readline())["linear_mps"] == 0.731, "another speed")
        program.stdin.close()
        check(program.wait(10) == 0, "exit code")


def recording(name, least, share):
    """Every object of a recording from the field is whole, and most are understood."""
    done = run("nmea", FOLDER / name)
    check(done.returncode == 0, done.stderr)
    objects = [json.loads(line) for line in done.stdout.splitlines()]
    good = [o for o in objects if "sentence" in o]
    check(all("sentence" in o or "refused" in o for o in objects), "an object says nothing")
    intact = (FOLDER / name).read_bytes().count(b"GGA,")
    ggas = sum(o["sentence"] == "GGA" for o in good)
    check(ggas == intact, f"{ggas} of {intact} GGA of {name}")
    check(len(good) >= least and len(good) >= share * len(objects),
          f"{len(good)} understood of {len(objects)}")


def moving_receiver():
    """gnss-haicom-moving.log"""
    recording("gnss-haicom-moving.log", 200, 0.9)


def rtk_receiver():
    """gnss-nmea-rtk.log"""
    recording("gnss-nmea-rtk.log", 200, 0.9)


def mixed_receiver():
    """gnss-zed-f9p-ubx-nmea.log"""
    recording("gnss-zed-f9p-ubx-nmea.log", 1500, 0.4)


if __name__ == "__main__":
    cases = [bunker_vectors, bunker_refusals, v1_has_another_0x211, nmea_vectors,
             nmea_between_other_bytes, ubx_vectors, sentences_and_frames_of_one_port, mti_vectors,
             mti_damage, usage_is_answered, a_closed_pipe_is_quiet, a_long_file_is_streamed, live_input_is_answered_at_once,
             nothing_to_decode]
    for case in (moving_receiver, rtk_receiver, mixed_receiver):
        if (FOLDER / case.__doc__).is_file():
            cases.append(case)
        else:
            print(f"skip - {case.__doc__}: {FOLDER / case.__doc__} is missing")
    sys.exit(run_cases(cases))
