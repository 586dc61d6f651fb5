#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes what the fuzzers of the decoders begin with: small streams of each format, and the
beginnings of the recordings where they are there (PURSUIT_TEST_DATA, else ../shared/data).

    make_seeds.py FOLDER
"""
import os
import pathlib
import struct
import sys

HOW = b"\0"  # the last byte: how the input is read


def evt3_words(*words):
    return struct.pack(f"<{len(words)}H", *words)


def aedat4_header(compression, streams):
    info = "<dv><node name=\"outInfo\">" + streams + "</node></dv>"
    text = info.encode()
    table = struct.pack("<HHHHHH", 10, 20, 4, 8, 16, 0)
    table += struct.pack("<iiqI", 12, compression, -1, 4)
    table += struct.pack("<I", len(text)) + text + bytes(8 - len(text) % 4)
    body = struct.pack("<I", 20) + b"IOHE" + table
    return b"#!AER-DAT4.0\r\n" + struct.pack("<I", len(body)) + body


def aedat4_events(*events):
    table = bytes(2) + struct.pack("<HHH", 6, 8, 4) + struct.pack("<iII", 6, 4, len(events))
    for t_us, x, y, on in events:
        table += struct.pack("<qhhB3x", t_us, x, y, on)
    body = struct.pack("<I", 16) + b"EVTS" + table
    return struct.pack("<I", len(body)) + body


def lz4_stored(data):
    return (b"\x04\x22\x4d\x18\x60\x40\x82" + struct.pack("<I", len(data) | 1 << 31) + data
            + bytes(4))


def zstd_stored(data):
    return (b"\x28\xb5\x2f\xfd\x20" + bytes([len(data)])
            + struct.pack("<I", 1 | len(data) << 3)[:3] + data)


def aedat4(compression, pack):
    stream = ("<node name=\"0\"><attr key=\"typeIdentifier\">EVTS</attr><node name=\"info\">"
              "<attr key=\"sizeX\">346</attr><attr key=\"sizeY\">260</attr></node></node>")
    packet = pack(aedat4_events((5, 1, 2, 1), (7, 345, 259, 0)))
    return (aedat4_header(compression, stream) + struct.pack("<iI", 0, len(packet)) + packet
            + struct.pack("<iI", 1, 2) + b"ab")


DAT = b"% Version 2\n% Width 304\n% Height 240\n\x0c\x08"
EVT2 = b"% evt 2.0\n% geometry 640x480\n% end\n"
EVT2_WORDS = struct.pack("<5I", 0x80000002, 0x10000801, 0x20C01002, 0xE0000000, 0x80000003)
EVT21_WORDS = struct.pack("<3Q", 8 << 60 | 2 << 32, 1 << 60 | 5 << 54 | 32 << 43 | 7 << 32 | 0x85,
                          10 << 60)
EVT3_WORDS = evt3_words(0x8001, 0x6005, 0x0007, 0x2803, 0x3820, 0x4805, 0x4000, 0x5081, 0x6009,
                        0x2001, 0xA000, 0xE123, 0xF000, 0x8002, 0x2004)
ES_DVS = b"Event Stream\x02\0\0\x01" + struct.pack("<HH", 64, 32)
ES_ATIS = b"Event Stream\x02\0\0\x02" + struct.pack("<HH", 64, 32)

SEEDS = {
    "dat": [DAT + struct.pack("<4I", 5, 1 | 2 << 14 | 1 << 28, 9, 3),
            b"% Version 1\n\0\x08" + struct.pack("<2I", 5, 3 | 9 << 9 | 1 << 17),
            struct.pack("<4I", 0xFFFFFFF0, 7, 3, 9)],
    "es": [ES_DVS + b"\x03\1\0\2\0\xff\xfe\x04\3\0\4\0",
           ES_ATIS + b"\x06\1\0\2\0\xff\xfc\x05\3\0\4\0\x03\3\0\4\0"],
    "raw": [EVT2 + EVT2_WORDS, b"% evt 2.1\n% end\n" + EVT21_WORDS,
            b"% format EVT3;height=720;width=1280\n" + EVT3_WORDS,
            b"% format EVT21;endianness=legacy;height=72;width=128\n% end\n" + EVT21_WORDS],
    "evt2": [EVT2_WORDS, EVT2 + EVT2_WORDS],
    "evt21": [EVT21_WORDS],
    "evt3": [EVT3_WORDS],
    "nmnist": [bytes([1, 2, 0x80, 0, 5, 3, 240, 0, 0, 6, 33, 33, 0, 0, 7])],
    "aedat2": [b"#!AER-DAT2.0\r\n# x\r\n" + struct.pack(">4I", 0x0306, 5, 0x0105, 9),
               b"#!AER-DAT2.0\r\n# AEChip: a.DAVIS240C\r\n"
               + struct.pack(">6I", 7 << 22 | 9 << 12 | 1 << 11, 5, 1 << 31, 6, 1 << 10, 7)],
    "aedat4": [aedat4(0, bytes), aedat4(1, lz4_stored), aedat4(3, zstd_stored)],
    "csv": [b"# geometry 64x32\nt_us,x,y,p\n5,1,2,1\n6,63,31,0\n",
            b"%geometry:64,32\nx,y,more,polarity,timestamp\n1,2,a,1,5\n"],
    "rpg": [b"# t x y p\n0.000005 1 2 1\n1.5 239 179 0\n"],
}

RECORDINGS = {
    "dat": ["car/car_atis_td.dat", "malformed/dat_time_wraps_32bit.dat"],
    "es": ["decoders/ncars_004397.es", "car/car_atis_td_em.es", "malformed/es_reset_bytes_inside.es"],
    "raw": ["decoders/evt2_sample.raw", "decoders/evt3_sample.raw", "decoders/evt3_triggers.raw"],
    "evt2": ["decoders/evt2_sample.raw", "malformed/evt2_no_time_high_first.raw"],
    "evt3": ["decoders/evt3_sample.raw", "decoders/evt3_triggers.raw",
             "malformed/evt3_starts_without_time_high.raw"],
    "nmnist": ["decoders/nmnist_digit.bin"],
    "aedat2": ["decoders/foam90.aedat"],
    "aedat4": ["decoders/two_cars.aedat4", "decoders/davis.aedat4"],
    "rpg": ["shapes_rotation/events.txt"],
}
BEGINNING = {"aedat4": 8000}  # its header alone is 3 kB


def main():
    folder = pathlib.Path(sys.argv[1])
    data = pathlib.Path(os.environ.get("PURSUIT_TEST_DATA", "../shared/data"))
    for name, seeds in SEEDS.items():
        (folder / name).mkdir(parents=True, exist_ok=True)
        for number, seed in enumerate(seeds):
            (folder / name / f"small_{number}").write_bytes(seed + HOW)
        for recording in RECORDINGS.get(name, []):
            path = data / recording
            if not path.exists():
                print(f"without the recording {path}")
                continue
            beginning = path.read_bytes()[:BEGINNING.get(name, 1500)]
            (folder / name / path.name).write_bytes(beginning + HOW)
        # Given as a list, not as a folder: to a folder the fuzzers would add what they find.
        paths = sorted(str(path) for path in (folder / name).iterdir())
        (folder / f"{name}.list").write_text(",".join(paths))


if __name__ == "__main__":
    main()
