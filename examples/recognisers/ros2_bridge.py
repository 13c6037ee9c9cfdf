#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A ROS 2 node as a recogniser. UNTESTED: ROS 2 was not there when this was written.

The node gets lines of a recording as std_msgs/String on /prehend/frames and publishes its events, each as one line of
docs/recognisers.md, on /prehend/events; after each frame it publishes {"ready": TICK}. python3 ros2_bridge.py grasping
hand object: the event that it finds, and its roles.
"""
import json
import sys

import rclpy
from std_msgs.msg import String

print(json.dumps({"recogniser": 1, "name": "ros2", "events": {sys.argv[1]: sys.argv[2:]}, "facts": ["poses", "trigger"]}),
      flush=True)
rclpy.init()
node = rclpy.create_node("prehend_bridge")
frames = node.create_publisher(String, "/prehend/frames", 100)
ready = -1


def answer(message):
    global ready
    print(message.data, flush=True)
    ready = json.loads(message.data).get("ready", ready)


node.create_subscription(String, "/prehend/events", answer, 100)
for text in sys.stdin:
    frames.publish(String(data=text))
    tick = json.loads(text).get("tick", -1)
    while ready < tick:
        rclpy.spin_once(node, timeout_sec=1)
rclpy.shutdown()
