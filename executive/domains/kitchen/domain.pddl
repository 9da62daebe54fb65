; What the kitchen robot can do. A place ?p is a spot for one cup, and the stand before it from which the arm reaches it.
(define (domain kitchen)
  (:requirements :strips :typing)
  (:types place cup)
  (:predicates
    (robot-at ?p - place)          ; the robot stands before ?p
    (cup-at ?c - cup ?p - place)
    (holding ?c - cup)
    (hand-empty)
    (arm-home)                     ; the arm is folded: the robot may drive
    (arm-out)                      ; it is not
    (open ?p - place)              ; the hand gets at ?p: nothing stands before it, or it has reached over that
    (free ?p - place))             ; no cup stands at ?p
  (:action navigate
    :parameters (?from ?to - place)
    :precondition (and (robot-at ?from) (arm-home))
    :effect (and (not (robot-at ?from)) (robot-at ?to)))
  (:action reach
    :parameters (?p - place)
    :precondition (and (robot-at ?p) (arm-home))
    :effect (and (not (arm-home)) (arm-out) (open ?p)))
  (:action fold ; an arm that was left out comes home, with or without a cup
    :parameters (?p - place)
    :precondition (and (robot-at ?p) (arm-out))
    :effect (and (not (arm-out)) (arm-home) (not (open ?p))))
  (:action grip ; the arm comes home with the cup
    :parameters (?c - cup ?p - place)
    :precondition (and (robot-at ?p) (open ?p) (cup-at ?c ?p) (hand-empty))
    :effect (and (not (cup-at ?c ?p)) (not (hand-empty)) (holding ?c) (free ?p)
                 (not (open ?p)) (not (arm-out)) (arm-home)))
  (:action put ; the arm comes home empty
    :parameters (?c - cup ?p - place)
    :precondition (and (robot-at ?p) (open ?p) (holding ?c) (free ?p))
    :effect (and (not (holding ?c)) (hand-empty) (cup-at ?c ?p) (not (free ?p))
                 (not (open ?p)) (not (arm-out)) (arm-home))))
