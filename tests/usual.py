# SPDX-License-Identifier: GPL-2.0-or-later
"""What most tests begin with, for ``from usual import *``. It needs no YADE; what needs it begins
with hosted.py."""

import contextlib  # noqa: F401
import csv  # noqa: F401
import json  # noqa: F401
import math  # noqa: F401
import os  # noqa: F401
import random  # noqa: F401
import re  # noqa: F401
import shutil  # noqa: F401
import signal  # noqa: F401
import subprocess  # noqa: F401
import sys  # noqa: F401
import time  # noqa: F401
from types import SimpleNamespace  # noqa: F401

import numpy as np  # noqa: F401
import pytest  # noqa: F401
from conftest import BUILD, ROOT, ran, runProgram, scenePath  # noqa: F401
from hypothesis import assume, given, settings  # noqa: F401
from hypothesis import strategies as some  # noqa: F401
from masonry.errors import Refused, ScriptRefused  # noqa: F401
from pytest import approx, mark, raises  # noqa: F401
